/* The scanner's driver, for a sketch: one header for all. */
#ifndef PLOMADA_SCIP_H
#define PLOMADA_SCIP_H

#include "drivers/scip_info.h"
#include "drivers/scip_layout.h"
#include "drivers/urg.h"

#endif
