import type { Wall } from './protocol/around';

const RAD = Math.PI / 180;
/** Two walls whose directions differ by less tell one component only: the error of the other would be four times theirs. */
const APART = Math.sin(15 * RAD);

/** How fast the vehicle moves over the floor, by the walls that it comes nearer to; `bearing` in degrees from the nose, clockwise.
 * `one`: the component towards that wall; along it nothing is known. `both`: the whole velocity. `error` is the mean error along it. */
export interface Speed {
  known: 'one' | 'both';
  mps: number;
  error: number;
  bearing: number;
}

/** Towards the other side when it goes away. */
function one(wall: Wall): Speed {
  return { known: 'one', mps: Math.abs(wall.mps), error: wall.error, bearing: wall.mps < 0 ? (wall.bearing + 180) % 360 : wall.bearing };
}

/** Least squares over all walls, each by its error: speed towards wall i is ahead * cos + right * sin of its bearing. */
export function speedOver(walls: Wall[]): Speed {
  const [first] = walls;
  const second = walls.find((wall) => Math.abs(Math.sin((wall.bearing - first!.bearing) * RAD)) >= APART);
  if (!second) return one(walls.reduce((a, b) => (b.error < a.error ? b : a)));
  let aa = 0, ar = 0, rr = 0, ya = 0, yr = 0;
  for (const { bearing, mps, error } of walls) {
    const a = Math.cos(bearing * RAD);
    const r = Math.sin(bearing * RAD);
    const weight = 1 / Math.max(error, 0.005) ** 2;
    aa += weight * a * a; ar += weight * a * r; rr += weight * r * r;
    ya += weight * a * mps; yr += weight * r * mps;
  }
  const det = aa * rr - ar * ar;
  const ahead = (rr * ya - ar * yr) / det;
  const right = (aa * yr - ar * ya) / det;
  const mps = Math.hypot(ahead, right);
  const [ca, cr] = mps > 0 ? [ahead / mps, right / mps] : [1, 0];
  const error = Math.sqrt((ca * ca * rr - 2 * ca * cr * ar + cr * cr * aa) / det);
  return { known: 'both', mps, error, bearing: (Math.atan2(right, ahead) / RAD + 360) % 360 };
}
