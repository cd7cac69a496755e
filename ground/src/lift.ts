/** Whether a vehicle that is tied down left the ground while its thrust rose: only then the thrust is near that of a hover, whatever
 * the vehicle weighs. A rise of both readings' errors together, 10 mm each (URG-04LX, 20 to 1000 mm), proves nothing. */
const SENSOR_M = 0.01;
export const LIFTED_M = 2 * SENSOR_M;
const LINES = 5; // a second of telemetry

export interface Lift {
  ground: number[]; // heights of the first second
  last: number[]; // of the latest
}
export const NO_LIFT: Lift = { ground: [], last: [] };

export function heightSeen(lift: Lift, height: number): Lift {
  if (Number.isNaN(height)) return lift;
  return lift.ground.length < LINES ? { ...lift, ground: [...lift.ground, height] } : { ...lift, last: [...lift.last, height].slice(-LINES) };
}

const middle = (values: number[]): number => [...values].sort((a, b) => a - b)[values.length >> 1] ?? NaN;

/** NaN: not enough was seen. */
export function rise(lift: Lift): number {
  return lift.last.length < LINES ? NaN : middle(lift.last) - middle(lift.ground);
}
