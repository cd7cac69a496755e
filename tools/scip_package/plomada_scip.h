/* The scanner's driver, for a sketch: one header for all. */
#ifndef PLOMADA_SCIP_H
#define PLOMADA_SCIP_H

#include "plomada/scip_info.h"
#include "plomada/scip_layout.h"
#include "plomada/scip_version.h"
#include "plomada/urg.h"

#endif
