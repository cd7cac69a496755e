import type { Recording } from './protocol/logs';
import texts from './story.json';

/** What happened in a flight, in sentences. The rules are those of tools/plot/story.py, which says where its figures come from;
 * ground/tests/unit/story.test.ts holds both to the same words. */
export interface StoryEvent {
  t: number; // of the recording
  kind: 'takeoff' | 'airborne' | 'landed' | 'land' | 'state' | 'command' | 'up' | 'down' | 'doubt' | 'limit' | 'out';
  text: string;
}

const EDGE_M = 0.05;
const EDGE_MPS = 1.1;
const SCANS_LOST_S = 0.35;
const TOGETHER_S = 0.5;
const MOVED_M = 0.1;
const LIMIT_LEAST_S = 0.5;
const SCAN_S = 0.1;
const OUT_TOGETHER_S = 0.35;
const OUT_LEAST_S = 0.25;
const LOW_M = 0.005;

type Told = Pick<Recording, 'time' | 'states'> & { reference: number[]; height: number[]; doubt: string[]; limit: string[]; out: string[] };

/** Ties go up. */
function rounded(value: number, digits: number): string {
  const scale = 10 ** digits;
  return (Math.floor(value * scale + 0.5) / scale).toFixed(digits);
}

function stretches(t: number[], values: string[], together: number, least = 0): [start: number, end: number, value: string][] {
  const found: [number, number, string][] = [];
  values.forEach((value, i) => {
    if (value === '') return;
    const end = Math.max(t[i + 1] ?? t[i]!, t[i]! + least);
    const before = found[found.length - 1];
    if (before && before[2] === value && t[i]! - before[1] <= together) before[1] = end;
    else found.push([t[i]!, end, value]);
  });
  return found;
}

/** whole: the recording begins where the recorder begins, with the take-off; a window of a longer one may begin anywhere. */
export function storyOf(told: Told, language: 'en' | 'es', whole: boolean, number: (text: string) => string = (text) => text): StoryEvent[] {
  const words = texts[language];
  const known = (table: Record<string, string>, name: string): string => table[name] ?? name;
  const { time: t, states, reference: ref, height } = told;
  const events: StoryEvent[] = [];
  const add = (at: number, kind: StoryEvent['kind'], text: string): void => void events.push({ t: at, kind, text });
  const lasting = (sentence: string, start: number, end: number, what: string): string => sentence.replace('{s}', number(rounded(end - start, 1))).replace('{what}', what);

  for (let i = 0; i < states.length; i++) {
    const now = states[i]!;
    const before = i > 0 ? states[i - 1]! : whole && now === 'TAKEOFF' ? 'GROUND' : now;
    if (now === before) continue;
    if (now === 'GROUND') add(t[i]!, 'landed', words.landed);
    else if (before === 'GROUND' && ref[i]! > 0) add(t[i]!, 'takeoff', words.takeoff.replace('{ref}', number(rounded(ref[i]!, 2))));
    else if (before === 'GROUND') add(t[i]!, 'airborne', words.airborne);
    else if (now === 'LANDING' && i > 0 && ref[i - 1]! > 0 && ref[i] === 0) add(t[i]!, 'land', words.land);
    else if (now in words.states) add(t[i]!, 'state', known(words.states, now));
  }

  const moves: { start: number; end: number; metres: number }[] = [];
  for (let i = 1; i < ref.length; i++) {
    const before = ref[i - 1]!;
    const now = ref[i]!;
    if (now === before || !(now > 0) || !(before >= 0) || states[i - 1] === 'GROUND' || Math.abs(now - before) <= LOW_M) continue;
    const last = moves[moves.length - 1];
    if (last && Math.abs(now - before) < MOVED_M && t[i]! - last.end <= TOGETHER_S) Object.assign(last, { end: t[i]!, metres: now });
    else moves.push({ start: t[i]!, end: t[i]!, metres: now });
  }
  for (const move of moves) add(move.start, 'command', words.command.replace('{ref}', number(rounded(move.metres, 2))));

  const steps: { start: number; end: number; metres: number }[] = [];
  let last = NaN;
  let lastT = NaN;
  height.forEach((now, i) => {
    if (Number.isNaN(now)) return;
    const gap = Math.max(t[i]! - lastT, SCAN_S);
    const step = now - last;
    if (states[i] !== 'GROUND' && gap <= SCANS_LOST_S && Math.abs(step) > EDGE_M + EDGE_MPS * gap) {
      const before = steps[steps.length - 1];
      if (before && t[i]! - before.end <= TOGETHER_S && before.metres * step > 0) Object.assign(before, { end: t[i]!, metres: before.metres + step });
      else steps.push({ start: t[i]!, end: t[i]!, metres: step });
    }
    last = now;
    lastT = t[i]!;
  });
  for (const step of steps) {
    const kind = step.metres > 0 ? 'down' : 'up';
    add(step.start, kind, words[kind].replace('{step}', number(rounded(Math.abs(step.metres), 2))));
  }

  for (const [start, end, reason] of stretches(t, told.doubt, TOGETHER_S)) add(start, 'doubt', lasting(words.doubt, start, end, known(words.reasons, reason)));
  for (const [start, end, limit] of stretches(t, told.limit.map((name, i) => (states[i] === 'GROUND' ? '' : name)), TOGETHER_S)) {
    if (end - start >= LIMIT_LEAST_S) add(start, 'limit', lasting(words.limit, start, end, known(words.limits, limit)));
  }
  for (const [start, end, out] of stretches(t, told.out, OUT_TOGETHER_S, SCAN_S)) {
    if (end - start >= OUT_LEAST_S) add(start, 'out', lasting(words.out, start, end, out.split('+').map((mirror) => known(words.mirrors, mirror)).join(words.and)));
  }
  return events.sort((a, b) => a.t - b.t);
}

/** Of a recording; what it does not have is not told. */
export function story(recording: Recording, language: 'en' | 'es', number?: (text: string) => string): StoryEvent[] {
  const { time, states, columns, names } = recording;
  return storyOf({ time, states, reference: columns.ref_m ?? [], height: columns.meas_m ?? [], doubt: names.doubt ?? [], limit: names.limit ?? [], out: names.out ?? [] }, language, true, number);
}
