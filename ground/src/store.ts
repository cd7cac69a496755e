import { batch, computed, signal, type Signal } from '@preact/signals';
import { OpenError, type Link, type LostReason, type OpenFailure } from './link/link';
import { openSerial } from './link/serial';
import { openSocket } from './link/socket';
import { openVehicle, VehicleLink } from './link/vehicle';
import { freshness, type Heard } from './freshness';
import { keep, kept } from './keep';
import type { Around, Wall } from './protocol/around';
import type { Beams } from './protocol/beams';
import { LineSplitter, parseLine, type Battery, type Line, type Telemetry } from './protocol/lines';
import { parseHelp, valueOf, type Parameter, type ParameterSet } from './protocol/parameters';
import { CommandQueue, type Outcome } from './protocol/queue';
import { LogCollector, logRest } from './protocol/recorder';
import { withSum } from './protocol/sum';
import { Series } from './series';
import { SessionLog, type Entry } from './session';

export type Phase = 'idle' | 'opening' | 'open' | 'lost';
export type StopState = 'none' | 'sent' | 'answered' | 'unanswered';
export type View = 'fly' | 'parameters' | 'recorder' | 'wizards' | 'console' | 'replay';

const CONSOLE_LINES = 2000;

export const phase = signal<Phase>('idle');
export const failure = signal<{ why: OpenFailure; detail: string } | null>(null);
export const lostReason = signal<LostReason | null>(null);
export const link = signal<Link | null>(null);
export const vehicle = computed(() => (link.value instanceof VehicleLink ? link.value : null));
export const clock = signal(0); // link's clock, ms, some times a second; it goes on when the link is gone
export const heardAny = signal(false); // any line of this firmware
export const foreign = signal(0); // lines that are not the firmware's
export const garbage = signal(0); // octets that are no text
export const openedAt = signal(0);
export const stopState = signal<{ STOP: StopState; LAND: StopState }>({ STOP: 'none', LAND: 'none' });
export const loading = signal(false);
export const consoleLines = signal<Entry[]>([]);
export const view = signal<View>('fly');
export const dialog = signal(true); // the connect sheet
export const notice = signal<string | null>(null);
export const series = new Series();
export const session = new SessionLog();
export const unkept = signal(0); // lines that the browser refuses to keep
export const unreadable = signal(0); // records that the browser has kept badly

const heardLast = signal<Heard | null>(null);
const pageClock = signal(0); // ms
/** The one owner of how fresh it is what the page shows. */
export const seen = computed(() => freshness(phase.value === 'open', heardLast.value, openedAt.value, { link: clock.value, page: pageClock.value }));
/** The telemetry, while it is so; null: nothing is known of now. */
export const live = computed(() => (seen.value.kind === 'live' ? seen.value.telemetry : null));

/** What belongs to the vehicle at the other end, and is forgotten when there may be another one. */
const perVehicle: (() => void)[] = [];
export function ofThisVehicle<T>(initial: T): Signal<T> {
  const value = signal(initial);
  perVehicle.push(() => (value.value = initial));
  return value;
}
function forgetVehicle(): void {
  batch(() => perVehicle.forEach((forget) => forget()));
}
export const parameters = ofThisVehicle<Parameter[]>([]);
export const stored = ofThisVehicle<ParameterSet | null>(null);
/** The latest scan that the vehicle told of, and when by the link's clock. */
export const scan = ofThisVehicle<{ beams: Beams; link: number } | null>(null);
/** What stands around, and how fast the walls come nearer, as told last. */
export const around = ofThisVehicle<{ around: Around; link: number } | null>(null);
export const drift = ofThisVehicle<{ walls: Wall[]; link: number } | null>(null);
/** The battery as it was told last: a full line has no place for it. */
const batteryTold = ofThisVehicle<{ battery: Battery; link: number } | null>(null);
const BATTERY_S = 3;
/** null: not measured, or nothing is known of now. */
export const batteryNow = computed(() => (live.value && batteryTold.value && heardLast.value && heardLast.value.link - batteryTold.value.link < BATTERY_S * 1000 ? batteryTold.value.battery : null));
export const storeLine = ofThisVehicle<string | null>(null); // what power-up said of the stored set

/** What a link that is open and says nothing useful is up to. */
export const diagnosis = computed<'silence' | 'wrongRate' | 'foreign' | null>(() => {
  if (phase.value !== 'open' || heardAny.value) return null;
  if (garbage.value > 20) return 'wrongRate';
  if (foreign.value > 3) return 'foreign';
  return clock.value - openedAt.value > 4000 ? 'silence' : null;
});

const splitter = new LineSplitter();
let queue: CommandQueue | null = null;
let pendingConsole: Entry[] = [];
export const listeners = new Set<(line: Line) => void>();

function record(out: boolean, text: string): void {
  const entry: Entry = { t: link.value?.now() ?? Date.now(), out, text };
  session.add(entry);
  pendingConsole.push(entry);
}

/** Whether every line that leaves carries its sum. A firmware with `#SUM ON` demands it, and the page notices by itself. */
export const sums = signal(kept('sums') === '1');
export function setSums(on: boolean): void {
  sums.value = on;
  keep('sums', on ? '1' : '0');
}

/** What LINK is, as far as it was heard; a link that is armed is kept alive, whatever else is sent. */
let linkSeconds = 0;
let lastSent = -Infinity;
export const ALIVE = '#PING alive';

function transmit(text: string): void {
  const line = sums.value ? withSum(text) : text;
  record(true, line);
  lastSent = link.value?.now() ?? 0;
  if (!CHANGES_NOTHING.test(text)) asPoweredOn = false;
  link.value?.send(line);
}

function heard(octets: Uint8Array): void {
  if (!link.value) return; // the last of a link that is being closed
  for (const text of splitter.push(octets)) {
    record(false, text);
    const line = parseLine(text);
    if (line.kind === 'other') {
      const odd = (text.match(/\ufffd/g) ?? []).length;
      garbage.value += odd;
      foreign.value++;
    } else {
      heardAny.value = true;
    }
    if (line.kind === 'telemetry') onTelemetry(line.telemetry);
    if (line.kind === 'beams') scan.value = { beams: line.beams, link: link.value.now() };
    if (line.kind === 'around') around.value = { around: line.around, link: link.value.now() };
    if (line.kind === 'drift') drift.value = { walls: line.walls, link: link.value.now() };
    if (line.kind === 'answer') onAnswer(line);
    queue?.heard(line);
    for (const listener of listeners) listener(line);
  }
}

function onTelemetry(telemetry: Telemetry): void {
  const now = link.value!.now();
  if (heardLast.value === null || telemetry.reset) void command('#GET LINK').then(giveBackLink);
  if (telemetry.reset) asPoweredOn = true;
  series.add(now / 1000, telemetry, vehicle.value ? vehicle.value.truth().height_m : NaN);
  batch(() => {
    heardLast.value = { telemetry, link: now, page: performance.now() };
    if (telemetry.battery) batteryTold.value = { battery: telemetry.battery, link: now };
    if (telemetry.reset) series.mark(now / 1000, `reset ${telemetry.reset}`).answered = true;
  });
}

function onAnswer(line: Extract<Line, { kind: 'answer' }>): void {
  if (line.name === 'LOAD' || line.name === 'SAVE') storeLine.value = line.text;
  if (!line.ok && line.rest.startsWith('sum missing')) setSums(true);
  if (line.ok && line.name === 'SUM' && /^(ON|OFF)$/.test(line.rest)) setSums(line.rest === 'ON');
  const value = line.ok ? valueOf(line.name, line.rest) : null;
  if (value?.name === 'LINK') linkSeconds = Number(value.value);
  if (value) known(value.name, value.value);
  if (line.ok && line.name === 'IMU') for (const [, name, found] of line.rest.matchAll(/([A-Z]+):(\S+)/g)) known(name!, found!);
}

/** The firmware has said what a parameter is. */
function known(name: string, value: string): void {
  if (parameters.value.some((p) => p.name === name)) parameters.value = parameters.value.map((p) => (p.name === name ? { ...p, value } : p));
}

/** A calibration sets LINK for a while. What it was is written down, so that also a page that died gives it back; to this vehicle, not to
 * that of another tab. */
const borrowed = (): string => `link.${link.value?.label ?? ''}`;
export function borrowLink(before: string): void {
  keep(borrowed(), before);
}
export async function giveBackLink(): Promise<void> {
  const name = borrowed();
  const before = kept(name);
  if (before !== null && (await command(`#LINK ${before}`)).ok) keep(name, null);
}

const MARKED = /^#(SETR|STOP|LAND|ARM|LAW|CALIBRATE|SAVE|LOAD|DEFAULTS|GRAV)\b/i;

/** Sends a command, again until it is answered, and gives up in time. */
export async function command(text: string, options: { tries?: number } = {}): Promise<Outcome> {
  if (!queue || phase.value !== 'open') return { ok: false, reason: 'not connected', silent: true, lines: [] };
  const mark = MARKED.test(text) ? series.mark(link.value!.now() / 1000, text.replace(/^#/, '')) : null;
  const outcome = await queue.command(text, options);
  if (mark) mark.answered = outcome.ok;
  return outcome;
}

/** Without a queue, as typed. */
export function sendRaw(text: string): void {
  if (phase.value === 'open') transmit(text);
}

export async function stop(name: 'STOP' | 'LAND'): Promise<void> {
  if (!queue || phase.value !== 'open') return;
  const mark = series.mark(link.value!.now() / 1000, name);
  stopState.value = { ...stopState.value, [name]: 'sent' };
  const answered = await queue.stop(name);
  mark.answered = answered;
  stopState.value = { ...stopState.value, [name]: answered ? 'answered' : 'unanswered' };
  if (answered) setTimeout(() => (stopState.value = stopState.value[name] === 'answered' ? { ...stopState.value, [name]: 'none' } : stopState.value), 4000);
}

/** Since a power-on that this page has heard nothing was sent that could change a parameter. */
let asPoweredOn = false;
const CHANGES_NOTHING = /^#\s*(GET|HELP|PING|LASER|PERF|VERSION|SETR|ARM|STOP|LAND|LOG|STREAM|IMU\s*(\*|$))/i;

/** False: not everything could be read. Whoever asks while it is being read waits for the same. */
let reading: Promise<boolean> | null = null;
export function readParameters(): Promise<boolean> {
  reading ??= readAll().finally(() => (reading = null));
  return reading;
}

async function readAll(): Promise<boolean> {
  loading.value = true;
  const help = await command('#HELP');
  const values = await command('#GET');
  const named = new Set(values.lines.map((line) => line.name)); // a command's choices look like a parameter's in #HELP
  const rows = help.lines.map((line) => parseHelp(line.rest)).filter((row): row is Parameter => row !== null && named.has(row.name));
  for (const line of values.lines) {
    const row = rows.find((p) => p.name === line.name);
    if (row) row.value = valueOf(line.name, line.rest)?.value ?? '';
  }
  const whole = help.ok && values.ok && rows.length === values.lines.length && rows.every((row) => row.value !== '');
  batch(() => {
    if (rows.length > 0) parameters.value = rows;
    if (whole && asPoweredOn) stored.value = valuesOf(rows);
    loading.value = false;
  });
  return whole;
}

export function valuesOf(rows: Parameter[]): ParameterSet {
  return Object.fromEntries(rows.map((p) => [p.name, p.value]));
}

function opened(kind: Link): void {
  batch(() => {
    splitter.reset();
    series.clear();
    link.value = kind;
    heardLast.value = null;
    openedAt.value = clock.value = kind.now();
    heardAny.value = false;
    foreign.value = garbage.value = 0;
    forgetVehicle();
    stopState.value = { STOP: 'none', LAND: 'none' };
    consoleLines.value = [];
    phase.value = 'open';
    lostReason.value = null;
    dialog.value = false;
  });
  queue = new CommandQueue(transmit, () => link.value?.now() ?? 0);
  void session.begin(kind.label);
  lastSent = -Infinity;
  linkSeconds = 0;
  asPoweredOn = false;
}

const events = {
  octets: heard,
  lost(reason: LostReason): void {
    queue?.clear('the link is gone');
    batch(() => {
      phase.value = 'lost';
      lostReason.value = reason;
      leaveLink();
    });
    void session.flush();
  },
};

async function open(how: () => Promise<Link>): Promise<void> {
  await disconnect();
  phase.value = 'opening';
  failure.value = null;
  try {
    opened(await how());
  } catch (error) {
    const open = error instanceof OpenError ? error : new OpenError('failed', String(error));
    failure.value = { why: open.failure, detail: open.detail };
    phase.value = 'idle';
  }
}

export const connectSerial = (port: () => Promise<SerialPort>): Promise<void> => open(async () => openSerial(await port(), events));
export const connectSocket = (url: string): Promise<void> => open(() => openSocket(url, events));
export const connectVehicle = (): Promise<void> => open(() => openVehicle(events, 1));

export async function disconnect(): Promise<void> {
  queue?.clear('disconnected');
  queue = null;
  const closing = link.value;
  batch(() => {
    phase.value = 'idle';
    leaveLink();
  });
  await closing?.close();
  session.leave();
  await session.flush();
}

/** The vehicle begins anew: so does what is known of it. */
export function powerCycle(): void {
  vehicle.value?.powerCycle();
  queue?.clear('power off');
  linkSeconds = 0;
  forgetVehicle();
}

// ---- the flight recorder ----

export interface Download {
  state: 'running' | 'repairing' | 'done' | 'failed' | 'none';
  received: number;
  expected: number;
  lost: number;
  csv: string;
}
export const download = signal<Download>({ state: 'none', received: 0, expected: 0, lost: 0, csv: '' });
const DUMP_SILENCE = 4000;
const DUMP_ROUNDS = 5;

function oneDump(collector: LogCollector, seconds: number | null): Promise<boolean> {
  return new Promise((resolve) => {
    let last = link.value?.now() ?? 0;
    let tries = 3;
    let begun = false;
    const ask = (): void => transmit(seconds === null ? '#LOG' : `#LOG ${seconds}`);
    const listener = (line: Line): void => {
      if (line.kind !== 'answer' || line.name !== 'LOG') return;
      last = link.value?.now() ?? 0;
      const rest = logRest(line.text);
      if (rest === null) {
        collector.damaged++;
        return;
      }
      begun ||= rest.startsWith('records:');
      collector.heard(rest);
      download.value = { ...download.value, received: Math.max(download.value.received, collector.size), expected: Math.max(download.value.expected, collector.expected) };
      if (begun && collector.complete) end(true);
    };
    const timer = setInterval(() => {
      const now = link.value?.now();
      if (now === undefined || phase.value !== 'open' || download.value.state === 'failed') end(false);
      else if (now - last > DUMP_SILENCE) {
        last = now;
        if (begun || --tries <= 0) end(begun);
        else ask();
      }
    }, 200);
    const end = (ok: boolean): void => {
      clearInterval(timer);
      listeners.delete(listener);
      resolve(ok);
    };
    listeners.add(listener);
    ask();
  });
}

/** All records; rows that were lost on the way are asked for again. */
export async function downloadRecorder(seconds: number | null): Promise<void> {
  if (download.value.state === 'running' || download.value.state === 'repairing' || phase.value !== 'open') return;
  const collector = new LogCollector();
  download.value = { state: 'running', received: 0, expected: 0, lost: 0, csv: '' };
  let ok = await oneDump(collector, seconds);
  let missing = collector.missingSeconds();
  for (let round = 0; ok && missing > 0 && round < DUMP_ROUNDS; round++) {
    download.value = { ...download.value, state: 'repairing' };
    ok = await oneDump(collector, missing);
    missing = collector.missingSeconds();
  }
  if ((download.value.state as string) === 'failed') return;
  download.value = { state: ok ? 'done' : 'failed', received: collector.size, expected: download.value.expected, lost: Math.max(0, download.value.expected - collector.size), csv: collector.size > 0 && collector.hasTitles ? collector.csv() : '' };
}

export function cancelDownload(): void {
  sendRaw('#LOG STOP');
  download.value = { ...download.value, state: 'failed' };
}

// ---- the page's heart ----

/** The link's clock when the link was left, and the page's. */
let left = { link: 0, page: 0 };
function leaveLink(): void {
  if (link.value) left = { link: link.value.now(), page: performance.now() };
  link.value = null;
}

function look(): void {
  pageClock.value = performance.now();
  if (link.value) clock.value = link.value.now();
  else if (heardLast.value) clock.value = left.link + (pageClock.value - left.page);
}

export function beat(): void {
  unkept.value = session.refused;
  unreadable.value = session.damaged;
  batch(look); // first: whatever fails below, the page does not stand still and look alive
  queue?.tick();
  if (phase.value === 'open' && linkSeconds > 0 && (link.value?.now() ?? 0) - lastSent > (linkSeconds * 1000) / 3) transmit(ALIVE);
  batch(() => {
    if (pendingConsole.length > 0) {
      consoleLines.value = [...consoleLines.value, ...pendingConsole].slice(-CONSOLE_LINES);
      pendingConsole = [];
    }
  });
}

/** At the start of the page: what a reload interrupted. */
export async function restore(): Promise<void> {
  await session.start();
  const [before] = await session.list();
  if (!before || Date.now() - before.last > 15 * 60_000 || before.lines === 0) return;
  if (await session.livesElsewhere(before.id)) return; // another tab flies: nothing was interrupted
  const entries = await session.read(before.id);
  if (phase.value !== 'idle') return; // the operator was quicker
  for (const entry of entries) {
    const line = parseLine(entry.text);
    if (line.kind === 'telemetry') series.add(entry.t / 1000, line.telemetry, NaN);
    else if (entry.out && MARKED.test(entry.text)) series.mark(entry.t / 1000, entry.text.slice(1).replace(/\*[0-9A-F]{4}$/, '')).answered = true;
  }
  consoleLines.value = entries.slice(-CONSOLE_LINES);
  restored.value = { link: before.link, lines: entries.length, id: before.id };
}
export const restored = signal<{ link: string; lines: number; id: number } | null>(null);
