import { readFileSync } from 'node:fs';
import { describe, expect, it } from 'vitest';
import { begins, parseDrift, parseSectors, type Sector } from '../../src/protocol/around';
import { parseLine } from '../../src/protocol/lines';
import { speedOver } from '../../src/walls';

/** What tests/drivers/test_around_line.c encodes: the line, then each sector. */
const vectors = readFileSync('../tests/fixtures/around/vectors.txt', 'utf8').split('\n').filter((line) => line !== '' && !line.startsWith('#')).map((line) => line.split(' '));

describe('the line of what stands around', () => {
  it('reads what the firmware’s own vectors say, never further than it is and at most 6.3 % nearer', () => {
    expect(vectors.length).toBe(4);
    for (const [line, ...was] of vectors) {
      const read = parseLine(line!);
      expect(read.kind, line).toBe('around');
      if (read.kind !== 'around') continue;
      expect(read.around.near).toBeNull();
      read.around.sectors.forEach((sector: Sector, i: number) => {
        if (was[i] === '.') expect(sector).toBe('nothing');
        else if (was[i] === '-') expect(sector).toBe('unseen');
        else {
          const mm = Math.max(Number(was[i]), 100);
          expect(sector).toBeLessThanOrEqual(mm);
          expect(sector).toBeGreaterThan(mm / 1.065);
        }
      });
    }
  });
  it('has the steps of the firmware’s table', () => {
    const table = /begins_mm\[\] = \{([^}]*)\}/.exec(readFileSync('../drivers/around_line.c', 'utf8'))![1]!.match(/\d+/g)!.map(Number);
    expect(table).toEqual(Array.from({ length: 62 }, (_, step) => begins(step)));
  });
  it('takes a torn or longer line for none', () => {
    const whole = vectors[0]![0]!;
    for (const torn of [whole.slice(0, -1), `${whole}.`, whole.slice(2), `${whole} near:1,2`, whole.replace('-2', '-0'), 'w:', 'w:-z-z', whole.replace('s', ':'), `${whole} drift:-`]) expect(parseLine(torn).kind, torn).toBe('other');
    expect(parseSectors('-z-B')).toEqual(Array(72).fill('unseen'));
  });
  it('tells what comes near', () => {
    expect(parseLine(`${vectors[0]![0]!} near:45,120,60`)).toMatchObject({ kind: 'around', around: { near: { bearing: 45, metres: 1.2, mps: 0.6 } } });
  });
});

describe('the speed by the walls', () => {
  it('reads walls, and that there is none', () => {
    expect(parseDrift('drift:-')).toEqual([]);
    expect(parseDrift('drift:95,132,-3,2')).toMatchObject([{ bearing: 95, metres: 1.32, mps: -0.03, error: 0.02 }]);
    expect(parseLine('drift:95,132,-3,2/5,220,12,4')).toMatchObject({ kind: 'drift', walls: [{ bearing: 95 }, { bearing: 5, mps: 0.12 }] });
    for (const torn of ['drift:', 'drift:95,132,-3', 'drift:95,132,-3,2/', 'drift:-/-']) expect(parseLine(torn).kind, torn).toBe('other');
  });
  const wall = (bearing: number, mps: number, error = 0.02) => ({ bearing, metres: 1, mps, error });
  it('of one wall knows the component towards it, and where it goes away the other direction', () => {
    expect(speedOver([wall(90, 0.3)])).toEqual({ known: 'one', mps: 0.3, error: 0.02, bearing: 90 });
    expect(speedOver([wall(90, -0.3)])).toEqual({ known: 'one', mps: 0.3, error: 0.02, bearing: 270 });
  });
  it('of two parallel walls, also one on either side, knows no more', () => {
    expect(speedOver([wall(90, 0.3, 0.05), wall(270, -0.3, 0.02)])).toMatchObject({ known: 'one', bearing: 90, error: 0.02 });
    expect(speedOver([wall(90, 0.3), wall(100, 0.3)]).known).toBe('one');
  });
  it('of two walls in a corner knows the whole velocity', () => {
    const speed = speedOver([wall(90, 0.3), wall(0, 0.4)]);
    expect(speed.known).toBe('both');
    expect(speed.mps).toBeCloseTo(0.5, 6);
    expect(speed.bearing).toBeCloseTo(36.87, 2);
    expect(speed.error).toBeCloseTo(0.02, 6);
  });
  it('has a greater error across walls that are nearly parallel, and none divides by zero', () => {
    const narrow = speedOver([wall(80, 0), wall(100, 0.1)]);
    expect(narrow.error).toBeGreaterThan(0.05);
    expect(Number.isFinite(speedOver([wall(90, 0, 0), wall(0, 0, 0)]).error)).toBe(true);
  });
});
