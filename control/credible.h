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

/* Ground that a vehicle stands on shows no more: that noise, and 10 mm by which the URG-04LX may be wrong
 * below a metre (its data sheet). */
#define GROUND_WITHIN_MM (1000.0F * HEIGHT_NO_NOISE_M + 10.0F)
#define HEIGHT_MIN_MM (-GROUND_WITHIN_MM)
#define HEIGHT_MAX_MM 5000.0F /* above the scanner's 4095 mm */

/* Below it a height may be that of the ground, as far as that is known, with any noise upon it; above it the
 * vehicle has left the ground. */
#define LOW_MM (GROUND_WITHIN_MM + 1000.0F * HEIGHT_NO_NOISE_M)
#define LOW_M (LOW_MM / 1000.0F)
#define IN_THE_AIR_M HEIGHT_NO_NOISE_M

/* So near its reference a law wants to climb no more: five sigma of law EST's hover on a bad vehicle, 20 mm
 * (95th percentile, docs/control.md). */
#define CONTENT_M 0.10F

/* So far from its reference law EST as delivered flies as fast as it may: VUP / POSK, 0.7 m/s by 2.3 1/s. A
 * reference farther away asks for no more. */
#define LAW_REACH_M 0.30F

/* So near the hover thrust a command is kept that nobody stands for: of another mode, without frames, heights
 * or a checked speed. By the vehicle's model it climbs or sinks at 0.3 m/s, as a descent does
 * (DESCENT_RATE_MM_S): 0.3 m/s * 2.4 1/s * 7 N / 9.81 m/s2. */
#define NEAR_HOVER_N 0.5F

#define HEIGHT_FRESH_US UINT32_C(300000) /* three scans of 0.1 s */
#define HEIGHT_FRESH_S ((float)HEIGHT_FRESH_US / 1.0e6F)
/* After a longer time the estimate may be off by LAW_REACH_M, so law EST would fly as fast as it may for
 * nothing: the accelerometer's largest bias, 0.25 m/s2 (tools/campaign/plan.py), makes that way within
 * sqrt(2 * 0.3 m / 0.25 m/s2), 1.55 s. Rounded down to scans. */
#define HEIGHT_LOST_US UINT32_C(1500000)
#define HEIGHT_LOST_S ((float)HEIGHT_LOST_US / 1.0e6F)

/* 45 degrees. Beyond it full thrust, 11.76 N, does not carry the heaviest vehicle, 8.4 N: acos(8.4 / 11.76)
 * is 44.4 degrees. */
#define TILTED_RAD 0.78539816F
#define TILTED_COS 0.70710678F /* cos(TILTED_RAD) */

/* At rest a mean of 80 frames counts: of 0.4 m/s2 of noise in each it leaves 0.045. So a tilt of a degree,
 * IMU_OFFSET_RAD, which is 0.171 m/s2 of gravity, is 3.8 sigma: one wrong mean of 7000. */
#define REST_TIME_S 2.0F
/* What must last to be the ground, or a vehicle at rest: ArduPilot, LAND_DETECTOR_TRIGGER_SEC. */
#define REST_HELD_S 1.0F

#define FRAME_GAP_US HEIGHT_FRESH_US /* what is older than heights that count is forgotten */
#define FRAME_GAP_S ((float)FRAME_GAP_US / 1.0e6F)
#define SPEED_MAX_MPS 4.0F /* a fall with the rotors off: 9.81 m/s2 / 2.4 1/s of damping */
#define UP_MAX_MPS2 200.0F /* above the Razor's range, 16 g */
#define BIAS_MAX_MPS2 1.5F /* chosen: 0.15 g, more than the accelerometer has */

#endif
