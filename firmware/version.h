/* Version of the firmware and of its tools, shown by #VERSION and `plomada --version`. Before 1.0.0 a new
 * middle number may change commands, telemetry or stored data; CHANGELOG.md tells what has changed. */
#ifndef FIRMWARE_VERSION_H
#define FIRMWARE_VERSION_H

#define PLOMADA_VERSION "0.2.0"

#endif
