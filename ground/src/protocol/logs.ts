import { parseLine } from './lines';
import { logRest } from './recorder';

/** A recording as columns; NaN where a row has no value. `time` in seconds. */
export interface Recording {
  name: string;
  kind: 'csv' | 'console' | 'telemetry';
  time: number[];
  columns: Record<string, number[]>;
  states: string[];
  notes: string[];
}

const NUMERIC = ['meas_m', 'est_m', 'innov_m', 'ref_m', 'thrust_n', 'roll_rad', 'pitch_rad', 'flags', 'height_m', 'abs_m', 'terrain_m', 'pulse_us'];

export function readCsv(text: string, name: string, kind: Recording['kind'] = 'csv'): Recording {
  const lines = text.split(/\r?\n/).filter((line) => line !== '');
  const titles = (lines[0] ?? '').split(',');
  const recording: Recording = { name, kind, time: [], columns: {}, states: [], notes: [] };
  const wanted = titles.map((title, i) => ({ title, i })).filter(({ title }) => NUMERIC.includes(title));
  for (const { title } of wanted) recording.columns[title] = [];
  const t = titles.indexOf('t_s');
  const s = titles.indexOf('state');
  if (t < 0) throw new Error('no column t_s');
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
  }
  if (cut > 0) recording.notes.push(`rows left out: ${cut}`);
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
  const recording: Recording = { name, kind: 'telemetry', time: [], columns: { meas_m: [], ref_m: [], thrust_n: [], flags: [] }, states: [], notes: [] };
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
  }
  return recording.time.length > 0 ? recording : null;
}

/** Every dump of the flight recorder in a console text, each a CSV, and how many rows were damaged. */
export function dumpsIn(text: string): { csv: string; damaged: number }[] {
  const dumps: { titles: string; rows: string[]; damaged: number }[] = [];
  for (const raw of text.split(/\r?\n|\r/)) {
    const line = STAMP.exec(raw)?.[3] ?? raw;
    if (!line.startsWith('OK LOG ')) continue;
    const rest = logRest(line);
    const current = dumps[dumps.length - 1];
    if (rest === null) {
      if (current) current.damaged++;
      continue;
    }
    const row = rest.replace(/^\d+ /, '');
    if (row.startsWith('t_s,')) dumps.push({ titles: row, rows: [], damaged: 0 });
    else if (current && /^\d+(\.\d+)?,/.test(row)) {
      if (row.split(',').length === current.titles.split(',').length) current.rows.push(row);
      else current.damaged++;
    }
  }
  return dumps.map((dump) => ({ csv: `${dump.titles}\n${dump.rows.join('\n')}\n`, damaged: dump.damaged }));
}

/** Everything plottable in a file, whatever of the known forms it has. Throws with a plain word when there is nothing. */
export function readLog(content: string, name: string): Recording[] {
  const text = fromXctu(content) ?? content;
  if (/^t_s,/.test(text)) return [readCsv(text, name)];
  const recordings = dumpsIn(text).map((dump, i) => {
    const recording = readCsv(dump.csv, `${name} · dump ${i + 1}`, 'console');
    if (dump.damaged > 0) recording.notes.push(`damaged rows left out: ${dump.damaged}`);
    return recording;
  }).filter((recording) => recording.time.length > 0);
  const telemetry = fromTelemetry(text, recordings.length > 0 ? `${name} · telemetry` : name);
  if (telemetry) recordings.push(telemetry);
  if (recordings.length === 0) throw new Error('neither a flight CSV, nor telemetry, nor a dump of the flight recorder');
  return recordings;
}
