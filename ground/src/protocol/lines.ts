import { parseAround, parseDrift, type Around, type Wall } from './around';
import { parseBeams, type Beams } from './beams';
import { splitSum } from './sum';

/** One telemetry line in numbers; NaN where the firmware has none. */
export interface Telemetry {
  height: number;
  reference: number;
  laser: string;
  thrust: number;
  state: string;
  flags: number;
  doubt?: string;
  limit?: string;
  reset?: string;
  /** Only with #BAT PIN, and where the line has room. `word`: what is wrong with it. */
  battery?: Battery;
}

export interface Battery {
  volts: number;
  word?: string;
}

export type Line =
  | { kind: 'telemetry'; text: string; telemetry: Telemetry }
  | { kind: 'beams'; text: string; beams: Beams }
  | { kind: 'around'; text: string; around: Around }
  | { kind: 'drift'; text: string; walls: Wall[] }
  /** `OK NAME rest` or `ERR NAME rest`; name is `-` for a line without one. */
  | { kind: 'answer'; text: string; ok: boolean; name: string; rest: string; damaged: boolean }
  | { kind: 'other'; text: string };

const FIELDS = /^[a-z_0-9]+:\S+(?: [a-z_0-9]+:\S+)*$/;
const ANSWER = /^(OK|ERR) (\S+)(?: (.*))?$/;
const NUMBER = /^-?\d+(\.\d+)?$/;

function number(text: string): number {
  return NUMBER.test(text) ? Number(text) : NaN;
}

function parseBattery(field: string): Battery {
  const [volts, word] = field.split('/');
  return word ? { volts: number(volts!), word } : { volts: number(volts!) };
}

/** Fields by name, so that a firmware with more of them, or in another order, is understood as far as it is known. */
function parseTelemetry(line: string): Telemetry | null {
  if (!FIELDS.test(line)) return null;
  const field = Object.fromEntries(line.split(' ').map((word) => [word.slice(0, word.indexOf(':')), word.slice(word.indexOf(':') + 1)]));
  const { alt, ref, laser, thr, state, flags, doubt, limit, reset, bat } = field;
  if (alt === undefined || (alt !== '-' && !NUMBER.test(alt)) || !NUMBER.test(ref ?? '') || thr === undefined || !laser || !state || !/^\d+$/.test(flags ?? '')) return null;
  const telemetry: Telemetry = { height: number(alt), reference: number(ref!), laser, thrust: number(thr), state, flags: Number(flags) };
  if (doubt) telemetry.doubt = doubt;
  if (limit) telemetry.limit = limit;
  if (reset) telemetry.reset = reset;
  if (bat) telemetry.battery = parseBattery(bat);
  return telemetry;
}

export function parseLine(line: string): Line {
  const telemetry = parseTelemetry(line);
  if (telemetry) return { kind: 'telemetry', text: line, telemetry };
  const beams = parseBeams(line);
  if (beams) return { kind: 'beams', text: line, beams };
  const around = parseAround(line);
  if (around) return { kind: 'around', text: line, around };
  const walls = parseDrift(line);
  if (walls) return { kind: 'drift', text: line, walls };
  const a = ANSWER.exec(line);
  if (a) {
    const { text, right } = splitSum(line);
    return { kind: 'answer', text: line, ok: a[1] === 'OK', name: a[2]!, rest: ANSWER.exec(text)?.[3] ?? '', damaged: right === false };
  }
  return { kind: 'other', text: line };
}

/** Octets to lines: CR LF, LF or CR end one. What is longer than any line of the firmware is cut there. */
export class LineSplitter {
  private partial = '';
  private static readonly LONGEST = 1000;

  push(octets: Uint8Array): string[] {
    const lines: string[] = [];
    for (const octet of octets) {
      if (octet === 10 || octet === 13) {
        if (this.partial !== '') lines.push(this.partial);
        this.partial = '';
      } else {
        this.partial += octet >= 32 && octet < 127 ? String.fromCharCode(octet) : '\ufffd';
        if (this.partial.length >= LineSplitter.LONGEST) {
          lines.push(this.partial);
          this.partial = '';
        }
      }
    }
    return lines;
  }

  reset(): void {
    this.partial = '';
  }
}
