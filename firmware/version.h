/* The version of the firmware and of its tools: told by #VERSION and by `plomada --version`. Before 1.0.0 a new middle number
 * may change commands, telemetry or what is stored; CHANGELOG.md says what. */
#ifndef FIRMWARE_VERSION_H
#define FIRMWARE_VERSION_H

#define PLOMADA_VERSION "0.1.0"

#endif
