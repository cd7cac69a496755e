import type { Telemetry } from './protocol/lines';

/** The page looks so often whether what it shows is still so, ms. */
export const BEAT_MS = 100;
/** Telemetry comes five times a second. Nothing may be shown as so 1.5 s after the last line (docs/ground.md); a beat until the page
 * notices and another one until it has drawn are taken off. */
export const LIVE_MS = 1500 - 2 * BEAT_MS;

/** What the page knows of the vehicle, and since when: the one answer that every view shows. `age` in ms. */
export type Seen =
  | { kind: 'nothing'; age: number } // since the link was opened
  | { kind: 'live'; age: number; telemetry: Telemetry }
  | { kind: 'old'; age: number; telemetry: Telemetry };

/** A line as it came, by the link's clock and by the page's own, ms. */
export interface Heard {
  telemetry: Telemetry;
  link: number;
  page: number;
}

/** Whichever clock says more counts: a simulated vehicle that flies faster than the page's clock has flown on for longer, and one
 * whose own clock stands still is silent all the same. */
export function freshness(open: boolean, heard: Heard | null, opened: number, now: { link: number; page: number }): Seen {
  if (heard === null) return { kind: 'nothing', age: now.link - opened };
  const age = Math.max(now.link - heard.link, now.page - heard.page, 0);
  return { kind: open && age <= LIVE_MS ? 'live' : 'old', age, telemetry: heard.telemetry };
}
