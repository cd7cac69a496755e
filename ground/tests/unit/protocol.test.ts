import { execFileSync } from 'node:child_process';
import { existsSync, mkdtempSync, readFileSync, readdirSync, writeFileSync } from 'node:fs';
import { tmpdir } from 'node:os';
import { join } from 'node:path';
import { describe, expect, it } from 'vitest';
import { freshness, LIVE_MS } from '../../src/freshness';
import { battery, batteryLimits, CELLS } from '../../src/battery';
import { heightSeen, LIFTED_M, NO_LIFT, rise } from '../../src/lift';
import { delivered, groupOf, presets } from '../../src/presets';
import { LineSplitter, parseLine, type Line } from '../../src/protocol/lines';
import { dumpsIn, fromXctu, readLog } from '../../src/protocol/logs';
import { differences, objection, parseHelp, parseSet, same, writeSet } from '../../src/protocol/parameters';
import { CommandQueue, LIST_PATIENCE, PATIENCE, TRIES, URGENT_PATIENCE, URGENT_PERIOD, type Outcome } from '../../src/protocol/queue';
import { LogCollector, logRest } from '../../src/protocol/recorder';
import { lineSum, splitSum, withSum } from '../../src/protocol/sum';
import { Series } from '../../src/series';
import { en, es } from '../../src/texts';

const octets = (text: string): Uint8Array => new TextEncoder().encode(text);
const answer = (text: string): Line => parseLine(text);

describe('lines', () => {
  it('reads the telemetry line of the operator’s guide', () => {
    const line = parseLine('alt:0.598 ref:0.600 laser:OK thr:7.12 state:FLYING flags:0');
    expect(line).toMatchObject({ kind: 'telemetry', telemetry: { height: 0.598, reference: 0.6, laser: 'OK', thrust: 7.12, state: 'FLYING', flags: 0 } });
  });
  it('takes a missing height for no number, and keeps the cause of a reset', () => {
    const line = parseLine('alt:- ref:0.000 laser:WAIT thr:0.00 state:GROUND flags:3 reset:POWER');
    expect(line.kind === 'telemetry' && Number.isNaN(line.telemetry.height) && line.telemetry.reset).toBe('POWER');
  });
  it('keeps what the firmware doubts, and is not confused by fields that it does not know', () => {
    expect(parseLine('alt:0.598 ref:0.600 laser:OK thr:7.12 state:FLYING flags:512 doubt:IMU')).toMatchObject({ kind: 'telemetry', telemetry: { flags: 512, doubt: 'IMU' } });
    expect(parseLine('alt:0.598 vz:-0.12 ref:0.600 laser:OK thr:7.12 state:FLYING flags:257 doubt:SIGHT wind:11.1')).toMatchObject({ telemetry: { height: 0.598, reference: 0.6, flags: 257, doubt: 'SIGHT' } });
  });
  it('tells the battery, with what is wrong, and without a voltage where there is none', () => {
    const told = (field: string): unknown => (parseLine(`alt:0.598 ref:0.600 laser:OK thr:7.12 state:FLYING flags:0 ${field}`) as { telemetry: { battery?: unknown } }).telemetry.battery;
    expect(told('limit:CLIMB')).toBeUndefined();
    expect(told('bat:14.8')).toEqual({ volts: 14.8 });
    expect(told('bat:14.1/LOW')).toEqual({ volts: 14.1, word: 'LOW' });
    expect(told('bat:-/ABSENT')).toEqual({ volts: NaN, word: 'ABSENT' });
  });
  it('every word on the battery has its sentence in both languages', () => {
    const words = [...readFileSync('../control/battery.c', 'utf8').matchAll(/\[BATTERY_(\w+)\] = "(\w+)"/g)].map((m) => m[2]!).filter((word) => !['OFF', 'WAITS', 'GOOD'].includes(word));
    expect(words.length).toBe(6);
    for (const texts of [en, es]) expect(Object.keys(texts.batteryWords).sort()).toEqual([...words].sort());
  });
  it('reads the line of the beams: a dash is not known, and never a zero', () => {
    expect(parseLine('mf:35,776,9,83,- m1:- m2:0,-,-,-,25 out:-')).toMatchObject({
      kind: 'beams', beams: { mirrors: { mf: { rays: 35, slant: 776, spread: 9, age: 83, lie: NaN }, m1: null, m2: { rays: 0, slant: NaN, lie: 25 } }, out: [] },
    });
    expect(parseLine('mf:8,1,2,3,4 m1:8,1,2,3,99 m2:8,1,2,3,4 out:m1+m2')).toMatchObject({ kind: 'beams', beams: { out: ['m1', 'm2'] } });
    for (const torn of ['mf:35,776,9,83 m1:- m2:- out:-', 'mf:35,776,9,83,- m1:- m2:-', 'mf:35,776,9,8x,- m1:- m2:- out:-', 'mf:,,,, m1:- m2:- out:-']) expect(parseLine(torn).kind).toBe('other');
  });
  it('takes half a telemetry line for none', () => {
    expect(parseLine('alt:0.5 ref:0.6 laser:OK').kind).toBe('other');
    expect(parseLine('alt:0.5x ref:0.600 laser:OK thr:7.12 state:FLYING flags:0').kind).toBe('other');
  });
  it('tells an answer from text that only contains one', () => {
    expect(parseLine('OK KP 0.015')).toMatchObject({ kind: 'answer', ok: true, name: 'KP', rest: '0.015' });
    expect(parseLine('ERR - commands begin with #')).toMatchObject({ kind: 'answer', ok: false, name: '-' });
    expect(parseLine(' OK KP 0.015').kind).toBe('other');
  });
  it('ends lines at LF, CR LF and CR wherever packets are cut', () => {
    const splitter = new LineSplitter();
    expect(splitter.push(octets('OK A\r'))).toEqual(['OK A']);
    expect(splitter.push(octets('\nOK B\nOK'))).toEqual(['OK B']);
    expect(splitter.push(octets(' C\r'))).toEqual(['OK C']);
  });
  it('cuts a line that never ends', () => {
    expect(new LineSplitter().push(octets('x'.repeat(2500)))).toHaveLength(2);
  });
});

describe('the sum of a line', () => {
  it('is CRC-16/CCITT-FALSE', () => expect(lineSum('123456789')).toBe(0x29b1));
  it('is put behind a command as the operator’s guide shows it, and only once', () => {
    expect(withSum('#SETR 0.6')).toBe('#SETR 0.6*9383');
    expect([withSum('#SETR 0.6*9383'), withSum('#setr 0.6*f00d')]).toEqual(['#SETR 0.6*9383', '#setr 0.6*f00d']);
  });
  it('agrees with the firmware’s example and finds a changed character', () => {
    const line = 'OK LOG 0 t_s,meas_m,est_m,innov_m,ref_m,thrust_n,roll_rad,pitch_rad,state,flags*BDE1';
    expect(splitSum(line).right).toBe(true);
    expect(splitSum(line.replace('meas', 'meaz')).right).toBe(false);
    expect(parseLine(line.replace('meas', 'meaz'))).toMatchObject({ damaged: true });
  });
});

describe('how fresh it is what was heard', () => {
  const telemetry = { height: 0.6, reference: 0.6, laser: 'OK', thrust: 7, state: 'FLYING', flags: 0 };
  const heard = { telemetry, link: 1000, page: 5000 };
  const at = (link: number, page: number, open = true): string => freshness(open, heard, 0, { link, page }).kind;
  it('is the older of what the link’s clock and the page’s say', () => {
    expect([at(1200, 5200), at(1000 + LIVE_MS + 1, 5200), at(1000, 5000 + LIVE_MS + 1)]).toEqual(['live', 'old', 'old']);
    expect(freshness(true, heard, 0, { link: 1200, page: 5900 }).age).toBe(900);
  });
  it('is old at once when the link is gone, and nothing where nothing was heard', () => {
    expect(at(1000, 5000, false)).toBe('old');
    expect(freshness(true, null, 400, { link: 1000, page: 1000 })).toEqual({ kind: 'nothing', age: 600 });
  });
});

describe('the command queue', () => {
  function rig() {
    let now = 0;
    const sent: string[] = [];
    const queue = new CommandQueue((text) => sent.push(text), () => now);
    const pass = (ms: number): void => {
      for (let i = 0; i < ms; i += 50) {
        now += 50;
        queue.tick();
      }
    };
    return { queue, sent, pass };
  }
  it('sends one command at a time', async () => {
    const { queue, sent } = rig();
    const first = queue.command('#KP 0.02');
    const second = queue.command('#KD 0.01');
    expect(sent).toEqual(['#KP 0.02']);
    queue.heard(answer('OK KP 0.02'));
    expect(sent).toEqual(['#KP 0.02', '#KD 0.01']);
    queue.heard(answer('ERR KD out of range 0..1 N/mm'));
    expect(await first).toMatchObject({ ok: true });
    expect(await second).toMatchObject({ ok: false, reason: 'out of range 0..1 N/mm', silent: false });
  });
  it('sends again until answered, and awaits no answer for ever', async () => {
    const { queue, sent, pass } = rig();
    const done = queue.command('#KP 0.02');
    pass(PATIENCE * TRIES + 200);
    expect(sent).toHaveLength(TRIES);
    expect(await done).toMatchObject({ ok: false, silent: true });
  });
  it('sends a command again soon when the firmware found its line damaged', () => {
    const { queue, sent, pass } = rig();
    void queue.command('#KP 0.02');
    queue.heard(answer('ERR - line damaged'));
    pass(100);
    expect(sent).toHaveLength(2);
  });
  it('sends a command again soon when the firmware wants a sum', () => {
    for (const reason of ['sum missing, see #SUM', 'wrong sum']) {
      const { queue, sent, pass } = rig();
      void queue.command('#KP 0.02');
      queue.heard(answer(`ERR - ${reason}`));
      pass(100);
      expect(sent).toHaveLength(2);
    }
  });
  it('takes no foreign answer for its own', () => {
    const { queue } = rig();
    let over = false;
    void queue.command('#KP 0.02').then(() => (over = true));
    queue.heard(answer('OK KD 0.02'));
    expect(over || !queue.busy).toBe(false);
  });
  it('collects a listing up to its count, and asks again when a line is missing', async () => {
    const { queue, sent } = rig();
    const done = queue.command('#GET');
    queue.heard(answer('OK SETR 0'));
    queue.heard(answer('OK GET END lines:2'));
    expect(sent).toEqual(['#GET', '#GET']);
    for (const text of ['OK SETR 0', 'OK KP 0.015', 'OK GET END lines:2']) queue.heard(answer(text));
    expect((await done).lines.map((line) => line.name)).toEqual(['SETR', 'KP']);
  });
  it('gives up on a listing that breaks off', async () => {
    const { queue, pass } = rig();
    const done = queue.command('#HELP');
    queue.heard(answer('OK HELP #SETR 0..3 m - Height reference; 0 lands.'));
    pass((LIST_PATIENCE + 100) * (TRIES + 1));
    expect(await done).toMatchObject({ ok: false, silent: true });
  });
  it('lets a value be answered by its own name', async () => {
    const { queue } = rig();
    const done = queue.command('#GET KP');
    queue.heard(answer('OK KP 0.015'));
    expect(await done).toMatchObject({ ok: true });
  });
  it('sends STOP before all that waits, repeats it until answered, and drops what waited', async () => {
    const { queue, sent, pass } = rig();
    void queue.command('#HELP');
    const dropped: Promise<Outcome> = queue.command('#SETR 0.6');
    const stopped = queue.stop('STOP');
    expect(sent).toEqual(['#HELP', '#STOP']);
    expect(await dropped).toMatchObject({ ok: false, reason: 'overtaken by a stop' });
    pass(URGENT_PERIOD * 2 + 50);
    expect(sent.filter((text) => text === '#STOP')).toHaveLength(3);
    queue.heard(answer('OK STOP'));
    expect(await stopped).toBe(true);
    pass(URGENT_PERIOD * 3);
    expect(sent.filter((text) => text === '#STOP')).toHaveLength(3);
  });
  it('says at last that STOP was not answered', async () => {
    const { queue, pass } = rig();
    const stopped = queue.stop('STOP');
    pass(URGENT_PATIENCE + 100);
    expect(await stopped).toBe(false);
  });
  it('ends everything when the link goes', async () => {
    const { queue } = rig();
    const command = queue.command('#KP 1');
    const stopped = queue.stop('LAND');
    queue.clear('gone');
    expect(await command).toMatchObject({ ok: false, reason: 'gone' });
    expect(await stopped).toBe(false);
  });
});

describe('parameters', () => {
  const kp = parseHelp('#KP 0..1 N/mm - PD, PID: proportional gain.')!;
  const law = parseHelp('#LAW PD|PID|PIDT|EST - Control law.')!;
  it('are read from the answers to #HELP', () => {
    expect(kp).toMatchObject({ name: 'KP', unit: 'N/mm', minimum: 0, maximum: 1, meaning: 'PD, PID: proportional gain.' });
    expect(law.choices).toEqual(['PD', 'PID', 'PIDT', 'EST']);
    expect(parseHelp('#IROLL ROLL|-ROLL|PITCH|-PITCH - The angle.')!.choices).toEqual(['ROLL', '-ROLL', 'PITCH', '-PITCH']);
    expect(parseHelp('#GET [NAME] - one parameter, or all')).toBeNull();
  });
  it('are refused before they are sent', () => {
    expect(['0.02', '1', ' 0 '].map((text) => objection(kp, text))).toEqual([null, null, null]);
    expect(['', '1.01', '-0.1', '1e-3', 'nan', '1,000.5', '0,0,5', '2,9'].map((text) => objection(kp, text))).toEqual(['empty', 'range', 'range', 'number', 'number', 'number', 'number', 'range']);
    expect(['0,5', '0.5'].map((text) => objection(kp, text))).toEqual([null, null]);
    expect([objection(law, 'est'), objection(law, 'LQR')]).toEqual([null, 'choice']);
  });
  it('survive a file', () => expect(parseSet(writeSet({ KP: '0.02', LAW: 'PID', L: '220', IROLL: '-ROLL' }))).toEqual({ KP: '0.02', LAW: 'PID', L: '220', IROLL: '-ROLL' }));
  it('show what a file would change, and never set a reference', () => {
    expect(differences({ SETR: '0', KP: '0.015', KI: '0.010' }, { SETR: '0.6', KP: '0.02', KI: '0.01', OLD: '1' })).toEqual([{ name: 'KP', from: '0.015', to: '0.02' }]);
  });
  it('compare as numbers', () => expect([same('7', '7.0'), same('7', '7.1'), same('PD', 'PID')]).toEqual([true, false, false]));
  it('as delivered are those of this firmware, and the presets set none that it does not have', () => {
    const rows = execFileSync('../build/plomada', ['params'], { encoding: 'utf8' }).split('\n').slice(1).filter((row) => row !== '').map((row) => row.trim().split(/\s+/));
    const table = Object.fromEntries(rows.map((cells) => [cells[0]!, cells[4]!]));
    expect(delivered).toEqual(table);
    expect(groupOf).toEqual(Object.fromEntries(rows.map((cells) => [cells[0]!, cells[5]!])));
    for (const words of [en, es]) expect(Object.keys(words.groups).sort()).toEqual([...new Set(Object.values(groupOf)), 'other'].sort());
    expect(Object.keys(es.meanings).filter((name) => !(name in table))).toEqual([]); // one that is missing is shown in the firmware's English
    for (const set of Object.values(presets)) expect(Object.keys(set).filter((name) => !(name in table))).toEqual([]);
  });
});

describe('what docs/hardware.md says', () => {
  const page = readFileSync('../docs/hardware.md', 'utf8');
  it('of the battery is what the checklist asks for', () => {
    const [, cells, full] = /battery: .*?, (\d)S .*?, ([\d.]+) V when full/.exec(page)!;
    const [, least, most] = /Battery, ([\d.]+) to ([\d.]+) V/.exec(page)!;
    expect(CELLS).toBe(Number(cells));
    expect(batteryLimits(CELLS).least).toBeCloseTo(Number(least), 6);
    expect(batteryLimits(CELLS).most).toBeCloseTo(Number(most), 6);
    expect(full).toBe(most);
    expect([11.2, Number(least), Number(most), 17.1, NaN, 0].map((volts) => battery(CELLS, volts))).toEqual(['low', 'good', 'good', 'many', 'none', 'none']);
  });
  it('of starting the motors is what stands at Arm, in its order', () => {
    const steps = page.slice(page.indexOf('## Starting the motors')).match(/^\d\. .*$/gm)!.slice(0, 4);
    const marks: [string, RegExp, RegExp, RegExp][] = [
      ['arm', /#ARM/, /Arm\./, /Armar\./], ['motors', /sticks .* motors start/, /sticks/, /palancas/], ['handOver', /switch to \*LaunchPad\*/, /switch to LaunchPad/, /interruptor a LaunchPad/], ['takeOff', /#SETR/, /Take off/, /Despegar/],
    ];
    for (const [i, [name, there, english, spanish]] of marks.entries()) {
      expect(steps[i]).toMatch(there);
      expect([Object.keys(en.armSteps)[i], Object.keys(es.armSteps)[i]]).toEqual([name, name]);
      expect(en.armSteps[name]).toMatch(english);
      expect(es.armSteps[name]).toMatch(spanish);
    }
  });
});

describe('whether a tied vehicle left the ground', () => {
  const seen = (heights: number[]): number => rise(heights.reduce(heightSeen, NO_LIFT));
  it('is told by a second of heights against the first second, and one wild height decides nothing', () => {
    expect(seen([0, 0.004, 0.002, 0.003, 0.001, 0.05, 0.05, 0.048, 0.052, 0.05])).toBeCloseTo(0.048, 6);
    expect(seen([0, 0, 0.3, 0, 0, 0, 0, 0, 0, 0.3])).toBe(0);
    expect(seen([0, NaN, 0, 0, 0, 0, NaN, 0.06, 0.06, 0.06, 0.06])).toBeNaN(); // four are too few
    expect(NaN >= LIFTED_M).toBe(false);
  });
});

describe('the flight recorder', () => {
  const row = (n: number): string => `${n} ${(70 + n / 10).toFixed(3)},0.6,0.6,,0.6,7.1,0,0,FLYING,0`;
  it('knows how far back a lost row lies, and is whole after a second dump', () => {
    const collector = new LogCollector();
    collector.heard('records:50');
    collector.heard('0 t_s,meas_m,est_m,innov_m,ref_m,thrust_n,roll_rad,pitch_rad,state,flags');
    for (let n = 1; n <= 50; n++) if (n !== 31) collector.heard(row(n));
    collector.heard('END lines:50');
    expect([collector.complete, collector.size]).toEqual([true, 49]);
    expect(collector.missingSeconds()).toBe(4); // 2.0 s behind the newest, and two to spare
    collector.heard('records:40');
    for (let n = 11; n <= 50; n++) collector.heard(row(n).replace(/^\d+/, String(n - 10)));
    collector.heard('END lines:40');
    expect([collector.missingSeconds(), collector.size]).toEqual([0, 50]);
    expect(collector.csv().split('\n')[31]).toMatch(/^73\.100,/);
  });
  it('leaves a damaged row out', () => {
    const good = withSum('OK LOG 1 70.100,0.6,0.6,,0.6,7.1,0,0,FLYING,0');
    expect(logRest(good)).toMatch(/^1 70\.100.*FLYING,0$/);
    expect([logRest(good.replace('7.1', '7.9')), logRest(good.slice(0, -5)), logRest(good.slice(0, -9))]).toEqual([null, null, null]);
  });
  it('keeps two rows of one millisecond, in their order (#LOG RATE FAST), and asks again for lost titles', () => {
    const collector = new LogCollector();
    collector.heard('records:2');
    collector.heard('1 70.100,0.6,FLYING,0,');
    collector.heard('2 70.100,0.6,FLYING,0,-0.2');
    collector.heard('END lines:2');
    expect([collector.size, collector.hasTitles, collector.missingSeconds()]).toEqual([2, false, 1]);
    collector.heard('records:1');
    collector.heard('0 t_s,meas_m,state,flags,up_mps2');
    collector.heard('1 70.100,0.6,FLYING,0,-0.2');
    collector.heard('END lines:1');
    expect(collector.csv()).toBe('t_s,meas_m,state,flags,up_mps2\n70.100,0.6,FLYING,0,\n70.100,0.6,FLYING,0,-0.2\n');
  });
});

describe('logs', () => {
  const titles = withSum('OK LOG 0 t_s,meas_m,est_m,innov_m,ref_m,thrust_n,roll_rad,pitch_rad,state,flags,up_mps2,pulse_us,age_s,bat_v,doubt,limit,bat,mf_rays,mf_mm,mf_spread_mm,mf_ms,mf_lie,m1_rays,m1_mm,m1_spread_mm,m1_ms,m1_lie,m2_rays,m2_mm,m2_spread_mm,m2_ms,m2_lie,out');
  const rest = ','.repeat(20);
  const rows = [withSum('OK LOG 1 74.312,0.598,0.598,,0.600,7.123,-0.0123,0.0345,FLYING,0,-0.214,1383.6,0.081' + rest), withSum('OK LOG 2 74.337,,0.598,,0.600,7.123,-0.0123,0.0345,FLYING,1,,1383.6,' + rest)];
  const telemetry = 'alt:0.598 ref:0.600 laser:OK thr:7.12 state:FLYING flags:0';
  const dump = ['OK LOG records:2', titles, rows[0], telemetry, rows[1], 'OK LOG END lines:2', ''].join('\r\n');
  const xctu = (text: string): string => {
    const hex = [...text].map((c) => c.charCodeAt(0).toString(16).padStart(2, '0')).join('').toUpperCase();
    return `02-05-2015 11:44:56.017,-,RECV,${hex.slice(0, 64)}\n02-05-2015 11:44:56.020,-,SENT,234C4F470A\n02-05-2015 11:44:56.117,-,RECV,${hex.slice(64)}\n`;
  };
  it('are as firmware writes them', () => expect(titles).toMatch(/\*5F9E$/)); // tests/firmware/test_verb_log.c
  it('may be a flight CSV', () => {
    const [flight] = readLog('t_s,meas_m,state,flags\n0.00,,GROUND,3\n0.01,0.5,FLYING,0\n0.02,0.', 'flight.csv');
    expect([flight!.time, flight!.columns.meas_m![1], flight!.notes.length]).toEqual([[0, 0.01], 0.5, 1]);
  });
  it('may be a console text with two dumps and telemetry', () => {
    expect(readLog(dump + dump, 'console.txt').map((r) => [r.kind, r.time.length])).toEqual([['console', 2], ['console', 2], ['telemetry', 2]]);
  });
  it('may be XCTU’s console log in hexadecimal, cut anywhere', () => {
    expect(fromXctu(xctu(dump))).toBe(dump);
    expect(dumpsIn(fromXctu(xctu(dump))!)[0]!.csv!.split('\n')).toHaveLength(4);
  });
  it('show accelerations, pulse and the age of the rays, and gaps where there is none', () => {
    const [recording] = readLog(dump, 'x');
    expect([recording!.columns.up_mps2, recording!.columns.pulse_us, recording!.columns.age_s]).toEqual([[-0.214, NaN], [1383.6, 1383.6], [0.081, NaN]]);
  });
  it('become octet by octet the CSV that `plomada log` writes', () => {
    const noTitles = dump.replace(`${titles}\r\n`, '');
    const texts: Record<string, string> = {
      whole: dump, two: dump + dump, damaged: dump.replace('7.123', '7.923'), 'missing row': dump.replace(`${rows[0]}\r\n`, ''), 'no titles': noTitles + dump, 'announcement lost': dump + dump.replace('OK LOG records:2\r\n', ''),
      'cut in a row': dump.slice(0, dump.indexOf('OK LOG 2') + 30), 'NULs of a radio that powers up': `\0\0${dump}`, 'LF alone': dump.replaceAll('\r\n', '\n'), 'a row without a sum': dump.replace(/\*[0-9A-F]{4}\r\nOK LOG END/, '\r\nOK LOG END'), 'XCTU': xctu(dump),
    };
    for (const [name, text] of Object.entries(texts)) {
      const folder = mkdtempSync(join(tmpdir(), 'plomada-log-'));
      writeFileSync(join(folder, 'console.txt'), text, 'latin1');
      try {
        execFileSync('../build/plomada', ['log', join(folder, 'console.txt'), '-o', folder], { stdio: 'ignore' });
      } catch (error) {
        expect((error as { status: number }).status, name).toBe(1); // something is missing, and the rest is written
      }
      const file = (i: number): string => join(folder, `console${i > 0 ? `-${i + 1}` : ''}.csv`);
      const ours = dumpsIn(fromXctu(text) ?? text);
      expect(ours.map(({ csv }) => csv), name).toEqual(ours.map((_, i) => (existsSync(file(i)) ? readFileSync(file(i), 'utf8') : null)));
      expect(readdirSync(folder).filter((one) => one.endsWith('.csv')).length, name).toBe(ours.filter(({ csv }) => csv !== null).length);
    }
  });
  it('may be a saved session', () => {
    const [flight] = readLog('1000 > #SETR 0.6\n1200 < alt:0.1 ref:0.600 laser:OK thr:7.12 state:TAKEOFF flags:0\n2200 < alt:0.2 ref:0.600 laser:OK thr:7.12 state:TAKEOFF flags:0\n', 's.txt');
    expect(flight!.time).toEqual([0, 1]);
  });
  it('that are nothing of the kind are refused', () => expect(() => readLog('hello', 'x')).toThrow());
});

describe('the series of the plots', () => {
  const line = { height: 0.6, reference: 0.6, laser: 'OK', thrust: 7, state: 'FLYING', flags: 0 };
  it('keeps a fixed number of rows', () => {
    const series = new Series();
    for (let i = 0; i < 40_000; i++) series.add(i / 5, line, NaN);
    expect([series.count, series.start, series.end]).toEqual([36_000, 800, 7999.8]);
    expect(series.window(7990, 7999.8).states).toHaveLength(50);
  });
  it('become a CSV that this page reads again', () => {
    const series = new Series();
    series.add(100, { ...line, height: NaN, flags: 1025 }, NaN);
    series.add(100.2, line, NaN);
    expect(series.csv()).toBe('t_s,meas_m,ref_m,thrust_n,state,flags\n0.000,,0.600,7.00,FLYING,1025\n0.200,0.600,0.600,7.00,FLYING,0\n');
    expect(readLog(series.csv(), 'x')[0]!.columns.flags).toEqual([1025, 0]);
  });
  it('shows a gap where lines are missing', () => {
    const series = new Series();
    for (const t of [0, 0.2, 0.4, 3, 3.2]) series.add(t, line, NaN);
    expect(series.window(0, 10).columns[1]).toEqual([expect.closeTo(0.6), expect.closeTo(0.6), expect.closeTo(0.6), null, expect.closeTo(0.6), expect.closeTo(0.6)]);
  });
});

describe('the words', () => {
  const header = readFileSync('../control/where/flight_state.h', 'utf8');
  it('know every flag of the firmware', () => {
    const flags = [...header.matchAll(/#define FLIGHT_FLAG_\w+[ \\\n]+(\d+)U/g)].map((match) => Number(match[1]));
    expect(flags.length).toBeGreaterThan(7);
    expect(flags.filter((flag) => en.flags[Math.log2(flag)] === undefined)).toEqual([]);
    expect(en.flags).toHaveLength(flags.length);
  });
  it('know every state of the scanner', () => {
    const names = /status_names\[\] = \{([^}]*)\}/.exec(readFileSync('../drivers/urg_link.c', 'utf8'))?.[1] ?? '';
    expect(Object.keys(en.lasers).sort()).toEqual([...names.matchAll(/"([A-Z0-9]+)"/g)].map((match) => match[1]!).sort());
  });
  it('know every state of the firmware', () => {
    const states = [...header.matchAll(/^ {4}FLIGHT_([A-Z]+),/gm)].map((match) => match[1]!);
    expect(Object.keys(en.states).sort()).toEqual(states.filter((state) => state !== 'STATE_COUNT').sort());
  });
});

describe('both languages', () => {
  it('say everything, and not the same', () => {
    const same = Object.keys(en).filter((key) => typeof en[key as keyof typeof en] === 'string' && en[key as keyof typeof en] === es[key as keyof typeof es]);
    expect(same.sort()).toEqual(['error', 'stop', 'stopHint', 'landHint'].sort());
    for (const key of ['failures', 'lostReasons', 'diagnoses', 'states', 'lasers', 'checks', 'stopStates', 'presetNames', 'imuSteps', 'objections', 'troubles', 'notes', 'unreadable', 'calibrationEnds', 'armSteps', 'groups', 'shows', 'batteryIs'] as const) expect(Object.keys(es[key])).toEqual(Object.keys(en[key]));
    expect(es.flags).toHaveLength(en.flags.length);
  });
});
