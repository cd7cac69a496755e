/** The nearest thing of a sector in mm; `nothing` was met by its rays; `unseen`: no ray looks there. */
export type Sector = number | 'nothing' | 'unseen';
export const SECTORS = 72; // of 5 degrees, from the nose clockwise

/** Something comes near: bearing in degrees, metres from the scanner, metres per second. */
export interface Near {
  bearing: number;
  metres: number;
  mps: number;
}

/** A wall, and how fast the vehicle comes nearer to it, with its mean error. */
export interface Wall extends Near {
  error: number;
}

export interface Around {
  sectors: Sector[];
  near: Near | null;
}

const DIGITS = '0123456789ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz';
/** Where each step of distance begins: 62 of them from 100 to 4100 mm (drivers/around_line.c). */
export const begins = (step: number): number => Math.round(100 * 41 ** (step / DIGITS.length));

/** null: not 72 sectors. */
export function parseSectors(text: string): Sector[] | null {
  const sectors: Sector[] = [];
  for (let i = 0; i < text.length; i++) {
    if (text[i] === '.') {
      sectors.push('nothing');
      continue;
    }
    const run = text[i] === '-';
    const digit = DIGITS.indexOf(run ? text[++i] ?? ' ' : text[i]!);
    if (digit < 0 || (run && digit === 0)) return null;
    if (run) sectors.push(...Array<Sector>(digit).fill('unseen'));
    else sectors.push(begins(digit));
  }
  return sectors.length === SECTORS ? sectors : null;
}

const LINE = /^w:([-.\w]+)(?: near:(\d+),(\d+),(\d+))?$/;
const DRIFT = /^drift:(-|\d+,\d+,-?\d+,\d+(?:\/\d+,\d+,-?\d+,\d+)*)$/;
const CM = 0.01;

/** `w:-2sstttrponmlkkj-3jjkklmnoprtwz..-c near:45,120,60`; null: no such line. */
export function parseAround(line: string): Around | null {
  const match = LINE.exec(line);
  const sectors = match && parseSectors(match[1]!);
  if (!match || !sectors) return null;
  const near = match[2] === undefined ? null : { bearing: Number(match[2]), metres: Number(match[3]) * CM, mps: Number(match[4]) * CM };
  return { sectors, near };
}

/** `drift:95,132,-3,2/5,220,12,4`, `drift:-`: no wall tells a speed; null: no such line. */
export function parseDrift(line: string): Wall[] | null {
  const match = DRIFT.exec(line);
  if (!match) return null;
  if (match[1] === '-') return [];
  return match[1]!.split('/').map((wall) => {
    const [bearing, distance, speed, error] = wall.split(',').map(Number);
    return { bearing: bearing!, metres: distance! * CM, mps: speed! * CM, error: error! * CM };
  });
}
