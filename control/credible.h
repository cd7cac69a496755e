/* What a measured height, tilt and frame can be, and for how long a height counts. All of control/ shares
 * these limits: with two of one kind, one part would believe what another refuses. */
#ifndef CONTROL_CREDIBLE_H
#define CONTROL_CREDIBLE_H

#include <stdint.h>

#define SCAN_S 0.1F /* a revolution of the URG-04LX, docs/scip.md */

/* chosen: two scans cannot be nearer; the line may deliver two at once */
#define SCAN_LEAST_S 0.02F

/* Standard deviation of the noisiest height, of the vehicles that tools/campaign/plan.py draws: 6 mm of all
 * rays of a scan, 10 mm of each of 35 rays, 1.5 mm by tilt and climb. */
#define HEIGHT_SIGMA_M 0.0064F
/* Six of them, rounded up to a centimetre: one scan of 500 million is off by more, one in a year. */
#define HEIGHT_NO_NOISE_M 0.04F

/* chosen: ground that a vehicle stands on shows no more, a mirror's lengths and uneven ground included */
#define GROUND_WITHIN_MM 50.0F
#define HEIGHT_MIN_MM (-GROUND_WITHIN_MM)
#define HEIGHT_MAX_MM 5000.0F /* above the scanner's 4095 mm */

/* chosen: above GROUND_WITHIN_MM; so low the vehicle may touch the ground */
#define LOW_MM 80.0F
#define LOW_M (LOW_MM / 1000.0F)
#define IN_THE_AIR_M HEIGHT_NO_NOISE_M

/* So near its reference a law wants to climb no more: five sigma of law EST's hover on a bad vehicle, 20 mm
 * (95th percentile, docs/control.md). */
#define CONTENT_M 0.10F

/* So near the hover thrust a command is kept that nobody stands for: of another mode, without frames, heights
 * or a checked speed. By the vehicle's model it climbs or sinks at 0.3 m/s, as a descent does
 * (DESCENT_RATE_MM_S): 0.3 m/s * 2.4 1/s * 7 N / 9.81 m/s2. */
#define NEAR_HOVER_N 0.5F

#define HEIGHT_FRESH_US UINT32_C(300000) /* three scans of 0.1 s */
#define HEIGHT_FRESH_S ((float)HEIGHT_FRESH_US / 1.0e6F)
#define HEIGHT_LOST_US UINT32_C(1500000) /* chosen: after a longer time the estimate has drifted too far */
#define HEIGHT_LOST_S ((float)HEIGHT_LOST_US / 1.0e6F)

/* 45 degrees. Beyond it full thrust, 11.76 N, does not carry the heaviest vehicle, 8.4 N: acos(8.4 / 11.76)
 * is 44.4 degrees. */
#define TILTED_RAD 0.78539816F
#define TILTED_COS 0.70710678F /* cos(TILTED_RAD) */

#define REST_TIME_S 2.0F /* chosen: at rest a mean of 80 frames counts, */
#define REST_HELD_S 1.0F /* chosen: and what it shows for 40 frames */

#define FRAME_GAP_US UINT32_C(300000) /* chosen: 12 frames lost; what came before is forgotten */
#define FRAME_GAP_S ((float)FRAME_GAP_US / 1.0e6F)
#define SPEED_MAX_MPS 4.0F /* a fall with the rotors off: 9.81 m/s2 / 2.4 1/s of damping */
#define UP_MAX_MPS2 200.0F /* above the Razor's range, 16 g */
#define BIAS_MAX_MPS2 1.5F /* chosen: 0.15 g, more than the accelerometer has */

#endif
