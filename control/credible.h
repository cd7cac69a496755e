/* What a measured height, tilt and frame can be, and for how long a height counts. All of control/ shares
 * these limits: with two of one kind, one part would believe what another refuses. */
#ifndef CONTROL_CREDIBLE_H
#define CONTROL_CREDIBLE_H

#include <stdint.h>

#define HEIGHT_MIN_MM (-50.0F) /* chosen: no noise reaches 50 mm below the ground */
#define HEIGHT_MAX_MM 5000.0F  /* above the scanner's 4095 mm */

/* chosen: above REST_BELOW_MM in supervisor.c; so low the vehicle may touch the ground */
#define LOW_MM 80.0F
#define LOW_M 0.08F
#define IN_THE_AIR_M 0.04F /* chosen: ten times the noise of a height */

/* chosen: 0.7 m/s2. So near the hover thrust a command is kept that nobody stands for: of another mode,
 * without frames, heights or a checked speed */
#define NEAR_HOVER_N 0.5F

#define HEIGHT_FRESH_US UINT32_C(300000) /* three scans of 0.1 s */
#define HEIGHT_FRESH_S 0.3F
#define HEIGHT_LOST_US UINT32_C(1500000) /* chosen: after a longer time the estimate has drifted too far */
#define HEIGHT_LOST_S 1.5F

#define TILTED_RAD 0.78539816F /* chosen: 45 degrees; more is a roll-over */
#define TILTED_COS 0.70710678F

#define FRAME_GAP_US UINT32_C(300000) /* chosen: 12 frames lost; what came before is forgotten */
#define FRAME_GAP_S 0.3F
#define UP_MAX_MPS2 200.0F /* above the Razor's range, 16 g */
#define BIAS_MAX_MPS2 1.5F /* chosen: 0.15 g, more than the accelerometer has */

#endif
