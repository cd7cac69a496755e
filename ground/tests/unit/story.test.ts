import { execFileSync } from 'node:child_process';
import { existsSync, mkdtempSync, writeFileSync, readFileSync } from 'node:fs';
import { tmpdir } from 'node:os';
import { join, resolve } from 'node:path';
import { describe, expect, it } from 'vitest';
import { readLog } from '../../src/protocol/logs';
import { story, type StoryEvent } from '../../src/story';
import texts from '../../src/story.json';

const ROOT = resolve(import.meta.dirname, '../../..');
const PLOMADA = join(ROOT, 'build/plomada');
const directory = mkdtempSync(join(tmpdir(), 'plomada-story-'));

/** What `make plot` tells of the file. */
function plotted(file: string): StoryEvent[] {
  return JSON.parse(execFileSync('python3', ['-B', join(ROOT, 'tools/plot/story.py'), file], { encoding: 'utf8' })) as StoryEvent[];
}
function told(text: string): StoryEvent[] {
  return story(readLog(text, 'x')[0]!, 'en');
}
/** Both, which are the same. */
function both(name: string, text: string): StoryEvent[] {
  const file = join(directory, name);
  writeFileSync(file, text);
  expect(told(text)).toEqual(plotted(file));
  return told(text);
}

const TITLES = 't_s,meas_m,est_m,innov_m,ref_m,thrust_n,roll_rad,pitch_rad,state,flags,doubt,limit,out';
type Row = { meas?: number | ''; ref?: number; state?: string; doubt?: string; limit?: string; out?: string };
/** A row each 50 ms, as the recorder has them; a scan in every second one. */
function log(seconds: number, at: (t: number, k: number) => Row): string {
  const rows = [TITLES];
  for (let k = 0; k < seconds * 20; k++) {
    const { meas = 0.6, ref = 0.6, state = 'FLYING', doubt = '', limit = '', out = '' } = at(k / 20, k);
    rows.push([(70 + k / 20).toFixed(3), meas, '', '', ref.toFixed(3), '7.000', '', '', state, 0, doubt, limit, k % 2 === 0 ? out : ''].join(','));
  }
  return `${rows.join('\n')}\n`;
}
const words = (events: StoryEvent[]): string[] => events.map(({ t, text }) => `${t.toFixed(2)} ${text}`);

describe('the story of a flight', () => {
  it('is told in the same words by the page and by the plot: every kind of event', () => {
    const events = both('all.csv', log(12, (t) => ({
      state: t < 1 ? 'TAKEOFF' : t < 8 ? 'FLYING' : t < 9 ? 'COASTING' : t < 11 ? 'LANDING' : 'GROUND',
      ref: t < 3 ? 0.6 : t < 9 ? 1 : 0,
      meas: t < 5 ? 0.6 : t < 6 ? 0.35 : 0.6,
      limit: t < 0.75 ? 'CLIMB' : t < 0.8 ? '' : t < 0.9 ? 'CLIMB' : t > 4 && t < 4.2 ? 'POWER' : t > 11 ? 'ACTUATOR' : '',
      doubt: t >= 8 && t < 9.2 ? 'SIGHT/blind' : '',
      out: t >= 6.4 && t < 6.8 ? 'm1+m2' : t >= 7 && t < 7.1 ? 'mf' : '',
    })));
    expect(words(events)).toEqual([
      '70.00 Take-off to 0.60 m.',
      '70.00 A limit holds the thrust for 0.9 s: no height has confirmed the climb: it is kept slow, or braked.',
      '73.00 The reference goes to 1.00 m.',
      '75.00 An edge: the ground comes 0.25 m nearer.',
      '76.00 An edge: the ground falls away by 0.25 m.',
      '76.40 The vote leaves out the aft mirror and the fore mirror for 0.4 s.',
      '78.00 The height is lost: it holds its thrust.',
      '78.00 A doubt, for 1.2 s: no mirror is believed: the vehicle moves, and their slants do not follow.',
      '79.00 The reference goes to 0: it lands.',
      '81.00 It is on the ground.',
    ]);
  });

  it('takes no climb, no descent and no lost scan for an edge', () => {
    expect(both('ways.csv', log(6, (_, k) => ({ meas: Number((0.3 + 0.7 * Math.floor(k / 2) * 0.1).toFixed(3)) })))).toEqual([]);
    expect(both('fall.csv', log(3, (_, k) => ({ meas: Number((3.9 - 1.1 * Math.floor(k / 2) * 0.1).toFixed(3)) })))).toEqual([]);
    expect(both('lost.csv', log(4, (t) => ({ meas: t < 1 ? 0.6 : t < 2 ? '' : 1.6 })))).toEqual([]);
  });

  it('tells a reference that a stick moves as one event, and two quick commands as two', () => {
    expect(words(both('stick.csv', log(4, (t) => ({ ref: t < 1 ? 0.6 : t < 3 ? Number((0.6 + 0.3 * (t - 1)).toFixed(3)) : 1.2 }))))).toEqual(['71.05 The reference goes to 1.20 m.']);
    expect(words(both('quick.csv', log(4, (t) => ({ ref: t < 1 ? 0.6 : t < 1.3 ? 1 : 0.5 }))))).toEqual(['71.00 The reference goes to 1.00 m.', '71.30 The reference goes to 0.50 m.']);
  });

  it('tells of old logs, which have no names, what they have', () => {
    const old = log(3, (t) => ({ state: t < 2 ? 'FLYING' : 'GROUND' })).split('\n').map((line) => line.split(',').slice(0, 10).join(',')).join('\n');
    expect(words(both('old.csv', old))).toEqual(['72.00 It is on the ground.']);
  });

  it('tells of telemetry what it has', () => {
    const line = (state: string, more = ''): string => `alt:0.598 ref:0.600 laser:OK thr:7.12 state:${state} flags:0${more}\r\n`;
    const text = line('GROUND').repeat(5) + 'mf:35,776,9,83,- m1:- m2:- out:-\r\n' + line('FLYING').repeat(5) + line('FLYING', ' doubt:IMU/alone').repeat(5) + line('GROUND').repeat(3);
    expect(words(both('seen.txt', text))).toEqual(['1.00 Take-off to 0.60 m.', '2.00 A doubt, for 1.0 s: the accelerometer tells another motion than mirrors and thrust.', '3.00 It is on the ground.']);
  });

  it.skipIf(!existsSync(PLOMADA))('is the same of flights of the firmware, with one mirror and with three', () => {
    for (const layout of ['FRONT', 'THREE']) {
      const file = join(directory, `${layout}.csv`);
      execFileSync(PLOMADA, ['fly', 'est-60cm-ramp', '--set', `LAYOUT=${layout}`, '--csv', file], { stdio: 'ignore' });
      const kinds = both(`${layout}.csv`, readFileSync(file, 'utf8')).map((event) => event.kind);
      expect(kinds).toContain('takeoff');
      expect(kinds).toContain('down'); // the edge of 25 cm
      expect(kinds.slice(-2)).toEqual(['land', 'landed']);
      expect(kinds.filter((kind) => kind === 'up' || kind === 'down')).toHaveLength(1);
      expect(kinds.includes('out')).toBe(layout === 'THREE');
    }
  });

  it('has a sentence for each rule and each limit of the firmware, in both languages', () => {
    const names = (path: string, table: string): string[] => [...new RegExp(`${table}\\[\\] = \\{(.*?)\\};`, 's').exec(readFileSync(join(ROOT, path), 'utf8'))![1]!.matchAll(/= "([^"]+)"/g)].map((m) => m[1]!).filter((name) => name !== '-');
    for (const language of ['en', 'es'] as const) {
      expect(Object.keys(texts[language].reasons)).toEqual(names('control/sense/verdict.c', 'reason_names'));
      expect(Object.keys(texts[language].limits)).toEqual(names('control/bounds.c', 'names'));
    }
  });
});
