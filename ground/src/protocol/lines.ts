import { splitSum } from './sum';

/** One telemetry line in numbers; NaN where the firmware has none. */
export interface Telemetry {
  height: number;
  reference: number;
  laser: string;
  thrust: number;
  state: string;
  flags: number;
  reset?: string;
}

export type Line =
  | { kind: 'telemetry'; text: string; telemetry: Telemetry }
  /** `OK NAME rest` or `ERR NAME rest`; name is `-` for a line without one. */
  | { kind: 'answer'; text: string; ok: boolean; name: string; rest: string; damaged: boolean }
  | { kind: 'other'; text: string };

const TELEMETRY = /^alt:(\S+) ref:(\S+) laser:(\S+) thr:(\S+) state:(\S+) flags:(\d+)(?: reset:(\S+))?(?: \S+)*$/;
const ANSWER = /^(OK|ERR) (\S+)(?: (.*))?$/;
const NUMBER = /^-?\d+(\.\d+)?$/;

function number(text: string): number {
  return NUMBER.test(text) ? Number(text) : NaN;
}

export function parseLine(line: string): Line {
  const t = TELEMETRY.exec(line);
  if (t && (t[1] === '-' || NUMBER.test(t[1]!)) && NUMBER.test(t[2]!)) {
    const telemetry: Telemetry = { height: number(t[1]!), reference: number(t[2]!), laser: t[3]!, thrust: number(t[4]!), state: t[5]!, flags: Number(t[6]) };
    if (t[7]) telemetry.reset = t[7];
    return { kind: 'telemetry', text: line, telemetry };
  }
  const a = ANSWER.exec(line);
  if (a) {
    const { text, right } = splitSum(a[3] ?? '');
    const whole = splitSum(line);
    return { kind: 'answer', text: line, ok: a[1] === 'OK', name: a[2]!, rest: right === null ? text : splitRest(whole.text), damaged: whole.right === false };
  }
  return { kind: 'other', text: line };
}

function splitRest(text: string): string {
  return ANSWER.exec(text)?.[3] ?? '';
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
