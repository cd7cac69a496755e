import { parseLine } from './lines';
import { logRest } from './recorder';

export interface Note {
  kind: 'cut' | 'damaged' | 'missing';
  count: number;
}

/** A recording as columns; NaN where a row has no value. `time` in seconds. */
export interface Recording {
  name: string;
  kind: 'csv' | 'console' | 'telemetry';
  csv: string | null; // octet by octet; null: telemetry, which is none
  time: number[];
  columns: Record<string, number[]>;
  /** What stands there in words: the reason of a doubt, the limit that holds, mirrors that were left out; '' where nothing does. */
  names: Record<string, string[]>;
  states: string[];
  notes: Note[];
}

const NAMES = ['doubt', 'limit', 'out'];

export function readCsv(text: string, name: string, kind: Recording['kind'] = 'csv'): Recording {
  const lines = text.split(/\r?\n/).filter((line) => line !== '');
  const titles = (lines[0] ?? '').split(',');
  const recording: Recording = { name, kind, csv: text, time: [], columns: {}, names: {}, states: [], notes: [] };
  const named = titles.map((title, i) => ({ title, i })).filter(({ title }) => NAMES.includes(title));
  const wanted = titles.map((title, i) => ({ title, i })).filter(({ title }) => title !== 't_s' && title !== 'state' && !NAMES.includes(title));
  for (const { title } of wanted) recording.columns[title] = [];
  for (const { title } of named) recording.names[title] = [];
  const t = titles.indexOf('t_s');
  const s = titles.indexOf('state');
  if (t < 0) throw new NothingToRead('noTime');
  let cut = 0;
  for (const line of lines.slice(1)) {
    const cells = line.split(',');
    if (cells.length !== titles.length || !Number.isFinite(parseFloat(cells[t]!))) {
      cut++;
      continue;
    }
    recording.time.push(Number(cells[t]));
    recording.states.push(s >= 0 ? cells[s]! : '');
    for (const { title, i } of wanted) recording.columns[title]!.push(cells[i] === '' ? NaN : Number(cells[i]));
    for (const { title, i } of named) recording.names[title]!.push(cells[i]!);
  }
  if (cut > 0) recording.notes.push({ kind: 'cut', count: cut });
  return recording;
}

/** XCTU's console log, `02-05-2015 11:44:56.017,-,RECV,2353...` (docs/operator.md); returns what was received. */
export function fromXctu(text: string): string | null {
  const lines = text.split(/\r?\n/);
  if (!lines.some((line) => /^\d+-\d+-\d+ [\d:.]+,[^,]*,(RECV|SENT),[0-9A-Fa-f ]*$/.test(line))) return null;
  let octets = '';
  for (const line of lines) {
    const match = /^\d+-\d+-\d+ [\d:.]+,[^,]*,RECV,([0-9A-Fa-f ]*)$/.exec(line);
    if (match) octets += (match[1]!.match(/[0-9A-Fa-f]{2}/g) ?? []).map((hex) => String.fromCharCode(parseInt(hex, 16))).join('');
  }
  return octets;
}

const STAMP = /^(\d+(?:\.\d+)?) ([<>]) (.*)$/; // a line of a saved session: milliseconds, direction, text

function fromTelemetry(text: string, name: string): Recording | null {
  const recording: Recording = { name, kind: 'telemetry', csv: null, time: [], columns: { meas_m: [], ref_m: [], thrust_n: [], flags: [] }, names: { doubt: [], limit: [] }, states: [], notes: [] };
  let stamped = NaN;
  let first = NaN;
  for (const raw of text.split(/\r?\n|\r/)) {
    const stamp = STAMP.exec(raw);
    if (stamp && stamp[2] === '>') continue;
    if (stamp) {
      stamped = Number(stamp[1]) / 1000;
      if (Number.isNaN(first)) first = stamped;
    }
    const line = parseLine(stamp ? stamp[3]! : raw);
    if (line.kind !== 'telemetry') continue;
    // Without time stamps a line comes every 200 ms.
    recording.time.push(stamp ? Math.round((stamped - first) * 1000) / 1000 : recording.time.length * 0.2);
    recording.columns.meas_m!.push(line.telemetry.height);
    recording.columns.ref_m!.push(line.telemetry.reference);
    recording.columns.thrust_n!.push(line.telemetry.thrust);
    recording.columns.flags!.push(line.telemetry.flags);
    recording.states.push(line.telemetry.state);
    recording.names.doubt!.push(line.telemetry.doubt ?? '');
    recording.names.limit!.push(line.telemetry.limit ?? '');
  }
  return recording.time.length > 0 ? recording : null;
}

export interface ConsoleDump {
  csv: string | null; // null: the row with the titles is missing
  rows: number;
  missing: number;
  damaged: number; // in the whole text, told with the first dump
}

/** Every dump of the flight recorder in a console text, as CSV octet by octet what `plomada log` writes. */
export function dumpsIn(text: string): ConsoleDump[] {
  const dumps: { rows: Map<number, string>; announced: number; ended: boolean }[] = [];
  let damaged = 0;
  const begin = (announced: number): (typeof dumps)[number] => {
    dumps.push({ rows: new Map(), announced, ended: false });
    return dumps[dumps.length - 1]!;
  };
  for (const raw of text.replaceAll('\0', '').split(/[\r\n]/).slice(0, -1)) {
    const line = STAMP.exec(raw)?.[3] ?? raw;
    const rest = line.startsWith('OK LOG ') ? line.slice(7) : '';
    if (rest.startsWith('records:')) begin(parseInt(rest.slice(8), 10));
    else if (rest.startsWith('END') && dumps.length > 0) dumps[dumps.length - 1]!.ended = true;
    else if (/^\d/.test(rest)) {
      const row = /^(\d{1,7}) (.*)$/.exec(logRest(line) ?? '');
      if (!row) {
        damaged++;
        continue;
      }
      // A number that is known already belongs to another dump, whose announcement was lost.
      const last = dumps[dumps.length - 1];
      const dump = !last || last.ended || last.rows.has(Number(row[1])) ? begin(-1) : last;
      dump.rows.set(Number(row[1]), row[2]!);
    }
  }
  return dumps.map(({ rows, announced }, i) => {
    const numbers = [...rows.keys()].sort((x, y) => x - y);
    const due = Math.max((numbers[numbers.length - 1] ?? -1) + 1, announced + 1);
    return { csv: rows.has(0) ? `${numbers.map((number) => rows.get(number)).join('\n')}\n` : null, rows: rows.size - Number(rows.has(0)), missing: due - rows.size, damaged: i === 0 ? damaged : 0 };
  });
}

/** Why a file shows nothing; a key of the texts. */
export class NothingToRead extends Error {
  constructor(readonly why: 'noTime' | 'nothing') {
    super(why);
  }
}

/** Everything plottable in a file, whatever of the known forms it has. */
export function readLog(content: string, name: string): Recording[] {
  const text = fromXctu(content) ?? content;
  if (/^t_s,/.test(text)) return [readCsv(text, name)];
  const recordings: Recording[] = [];
  dumpsIn(text).forEach((dump, i) => {
    if (dump.csv === null || dump.rows === 0) return;
    const recording = readCsv(dump.csv, `${name} · ${i + 1}`, 'console');
    if (dump.damaged > 0) recording.notes.push({ kind: 'damaged', count: dump.damaged });
    if (dump.missing > 0) recording.notes.push({ kind: 'missing', count: dump.missing });
    recordings.push(recording);
  });
  const telemetry = fromTelemetry(text, recordings.length > 0 ? `${name} · alt:` : name);
  if (telemetry) recordings.push(telemetry);
  if (recordings.length === 0) throw new NothingToRead('nothing');
  return recordings;
}
