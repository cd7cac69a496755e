/** What the firmware tells of one mirror's rays; NaN is what it does not know. Millimetres, milliseconds, percent. */
export interface Beam {
  rays: number;
  slant: number;
  spread: number;
  age: number;
  lie: number;
}
/** Mirrors by the names of the parameters: F in front, 1 aft, 2 fore. */
export type Mirror = 'mf' | 'm1' | 'm2';
export const MIRRORS: readonly Mirror[] = ['m1', 'mf', 'm2']; // as their rays are taken

export interface Beams {
  mirrors: Record<Mirror, Beam | null>; // null: not known, LAYOUT does not have it
  out: Mirror[]; // that the vote left out
}

const PART = '(?:-|\\d+)';
const BEAM = `(-|\\d+(?:,${PART}){4})`;
const LINE = new RegExp(`^mf:${BEAM} m1:${BEAM} m2:${BEAM} out:(-|m[f12](?:\\+m[f12])*)$`);

function beam(text: string): Beam | null {
  if (text === '-') return null;
  const [rays, slant, spread, age, lie] = text.split(',').map((part) => (part === '-' ? NaN : Number(part)));
  return { rays: rays!, slant: slant!, spread: spread!, age: age!, lie: lie! };
}

/** `mf:8,776,9,83,0 m1:8,804,28,108,99 m2:- out:m1`; null: no such line. */
export function parseBeams(line: string): Beams | null {
  const match = LINE.exec(line);
  if (!match) return null;
  const [, mf, m1, m2, out] = match;
  return { mirrors: { mf: beam(mf!), m1: beam(m1!), m2: beam(m2!) }, out: out === '-' ? [] : (out!.split('+') as Mirror[]) };
}
