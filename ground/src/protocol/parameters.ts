import { typed } from './decimal';

/** A row of the firmware's own table, from its answers to #HELP and #GET. */
export interface Parameter {
  name: string;
  unit: string;
  minimum: number;
  maximum: number;
  choices: string[] | null;
  meaning: string;
  value: string;
}

export type ParameterSet = Record<string, string>;

const ROW = /^#(\S+) (?:(-?[\d.]+)\.\.(-?[\d.]+) (\S+)|(-?[A-Z0-9]+(?:\|-?[A-Z0-9]+)+))(?: .*?)? - (.*)$/;

/** `#KP 0..1 N/mm - PID: proportional gain.`; null for a command that is no parameter. */
export function parseHelp(rest: string): Parameter | null {
  const match = ROW.exec(rest);
  if (!match) return null;
  const choices = match[5] ? match[5].split('|') : null;
  return { name: match[1]!, unit: match[4] ?? '', minimum: choices ? 0 : Number(match[2]), maximum: choices ? choices.length - 1 : Number(match[3]), choices, meaning: match[6]!, value: '' };
}

/** `KP 0.015` of an answer to #GET or a set command. */
export function valueOf(name: string, rest: string): { name: string; value: string } | null {
  const words = rest.split(' ');
  if (name === 'GET') return null;
  return words[0] ? { name, value: words[0] } : null;
}

/** Why this text may not be sent as the parameter's value; null: it may. */
export function objection(parameter: Parameter, text: string): 'empty' | 'number' | 'range' | 'choice' | null {
  const value = typed(text);
  if (value === '') return 'empty';
  if (parameter.choices) return parameter.choices.includes(value.toUpperCase()) ? null : 'choice';
  if (!/^[+-]?(\d+\.?\d*|\.\d+)$/.test(value)) return 'number';
  const number = Number(value);
  return number < parameter.minimum || number > parameter.maximum ? 'range' : null;
}

export function same(a: string | undefined, b: string | undefined): boolean {
  if (a === undefined || b === undefined) return a === b;
  return a === b || (a !== '' && b !== '' && Number.isFinite(Number(a)) && Math.abs(Number(a) - Number(b)) <= 1e-6 * Math.max(1, Math.abs(Number(a))));
}

export interface Difference {
  name: string;
  from: string;
  to: string;
}

/** What would change. SETR is no setting: it makes the vehicle fly. */
export function differences(now: ParameterSet, wanted: ParameterSet): Difference[] {
  return Object.entries(wanted)
    .filter(([name, value]) => name !== 'SETR' && name in now && !same(now[name], value))
    .map(([name, value]) => ({ name, from: now[name]!, to: value }));
}

/** A file of `#NAME value` lines (also without `#`); everything else is a comment. */
export function parseSet(text: string): ParameterSet {
  const set: ParameterSet = {};
  for (const line of text.split(/\r?\n/)) {
    const match = /^\s*#?\s*([A-Z][A-Z0-9_]{0,11})[ =]+([A-Za-z0-9.,+-]+)\s*(?:\/\/.*|;.*)?$/.exec(line);
    if (match) set[match[1]!] = typed(match[2]!).toUpperCase();
  }
  return set;
}

export function writeSet(set: ParameterSet): string {
  return Object.entries(set).filter(([name]) => name !== 'SETR').map(([name, value]) => `#${name} ${value}\r\n`).join('');
}
