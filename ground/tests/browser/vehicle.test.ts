import { execFileSync } from 'node:child_process';
import { mkdtempSync, readFileSync, statSync } from 'node:fs';
import { tmpdir } from 'node:os';
import { join } from 'node:path';
import type { Browser, Page } from 'playwright-core';
import { afterAll, afterEach, beforeAll, describe, expect, it } from 'vitest';
import { big, button, openBrowser, openPage, parameter, picture, PLOMADA, ROOT, serveSite, startVehicle, tab, untilHeight, untilLaserIsOk, untilState, type Site } from './rig';

let browser: Browser;
let site: Site;
let page: Page;

beforeAll(async () => {
  site = await serveSite();
  browser = await openBrowser();
});
afterAll(async () => {
  await browser?.close();
  site?.close();
});
afterEach(async () => {
  await page?.context().close();
});

const body = (): Promise<string> => page.innerText('body');

async function airborne(speed = '5×'): Promise<void> {
  page = await openPage(browser, site.url);
  await startVehicle(page, speed);
  await untilLaserIsOk(page);
  await button(page, 'Take off').click();
  await untilHeight(page, 0.6, 0.06);
}

describe('the simulated vehicle, the unmodified firmware as WebAssembly', () => {
  it('is flown by a person who has only a browser within a minute, in real time, from a file on the disk', async () => {
    const begin = Date.now();
    page = await openPage(browser, `file://${join(ROOT, 'build-ground/index.html')}`);
    await picture(page, 'connect');
    await startVehicle(page);
    await untilLaserIsOk(page);
    await button(page, 'Take off').click();
    await untilHeight(page, 0.6, 0.06);
    expect((Date.now() - begin) / 1000).toBeLessThan(60);
    await page.waitForTimeout(6000);
    await page.getByRole('button', { name: '20 s', exact: true }).click();
    await page.waitForTimeout(500);
    await picture(page, 'fly');
    await page.getByRole('button', { name: 'Light or dark' }).click();
    await page.waitForTimeout(300);
    await picture(page, 'fly-dark');
  });

  it('flies est-60cm-ramp with the metrics of the native build', async () => {
    const json = join(mkdtempSync(join(tmpdir(), 'plomada-')), 'flight.json');
    execFileSync(PLOMADA, ['fly', 'est-60cm-ramp', '--seed', '1', '--json', json]);
    page = await openPage(browser, site.url);
    await button(page, 'Close').click();
    await tab(page, 'Replay').click();
    await button(page, 'Fly').last().click();
    await page.waitForSelector('#metrics', { state: 'attached' });
    expect(JSON.parse((await page.locator('#metrics').textContent())!)).toEqual(JSON.parse(readFileSync(json, 'utf8')));
    await page.waitForTimeout(300);
    await picture(page, 'replay');
  });

  it('shows the place from the side and from above, with the three beams that end where the ground is', async () => {
    page = await openPage(browser, site.url);
    await startVehicle(page, '5×');
    const heights = (): Promise<number[]> => page.locator('.picture .beam').evaluateAll((beams) => beams.map((beam) => Number((beam as SVGElement).dataset.height)));
    const side = page.getByRole('img', { name: /^from the side/ });
    const above = page.getByRole('img', { name: /^from above/ });
    expect(await above.locator('.block').count()).toBe(0);
    await button(page, 'Hall').click();
    await page.waitForFunction(() => document.querySelectorAll('.above .block').length === 11); // a ramp, a platform, a table with its legs, stairs and a wall
    expect(await above.locator('.way').count()).toBe(1);
    await untilLaserIsOk(page);
    await button(page, 'Take off').click();
    await untilHeight(page, 0.6, 0.06);
    expect(await heights()).toEqual([0, 0, 0]);
    await button(page, '1×').click();
    await button(page, 'Fly the way').click();
    await page.waitForFunction(() => [...document.querySelectorAll<SVGElement>('.beam')].every((beam) => beam.dataset.height === '0.250'), undefined, { timeout: 20_000 });
    const ground = (await side.locator('.earth').getAttribute('points'))!.split(' ').map((point) => Number(point.split(',')[1]));
    expect(Math.min(...ground)).toBeCloseTo(150 - 70 * 0.25, 1); // the platform under it, 70 pixels a metre
    const spots = await above.locator('.spot').evaluateAll((all) => all.map((spot) => Number(spot.getAttribute('cy'))));
    expect(spots.every((y) => y > 130 / 2)).toBe(true); // to the right of a vehicle that flies along x
    await picture(page, 'place', '.pictures');
    await button(page, 'Unplug laser').click();
    await page.waitForFunction(() => document.querySelectorAll('.beam, .spot').length === 0);
  });

  it('flies in a place file of one\'s own, and says what is wrong in one', async () => {
    page = await openPage(browser, site.url);
    await startVehicle(page, '5×');
    const choose = (text: string): Promise<void> => page.locator('.file input').setInputFiles({ name: 'own.place', mimeType: 'text/plain', buffer: Buffer.from(text) });
    await choose('block 1 0 1 1 0.3\nblok 2');
    await page.waitForFunction(() => document.querySelector('.places .banner')?.textContent?.startsWith('line 2: '));
    expect(await page.locator('.above .block').count()).toBe(0);
    await choose('block 1 0 1 1 0.3\nblock 3 1 1 1 0.5\ngo 0 2 0 0.5');
    await page.waitForFunction(() => document.querySelectorAll('.above .block').length === 2 && !document.querySelector('.places .banner'));
    await button(page, 'Power off and on').click();
    await page.waitForTimeout(500);
    expect(await page.locator('.above .block').count()).toBe(2); // the place stays
    await button(page, 'Even floor').click();
    await page.waitForFunction(() => document.querySelectorAll('.above .block').length === 0);
    await untilLaserIsOk(page);
    await button(page, 'Take off').click();
    await untilHeight(page, 0.6, 0.06);
    await button(page, 'Send the ramp').click();
    await page.waitForFunction(() => document.querySelectorAll('.above .block').length === 2);
  });

  it('obeys STOP by Esc and LAND by L from every view, and shows that they were answered', async () => {
    await airborne('2×');
    await tab(page, 'Console').click();
    await page.locator('#command').focus();
    await page.keyboard.press('Escape');
    await page.waitForSelector('.stop.answered', { timeout: 5000 });
    await tab(page, 'Fly').click();
    await untilState(page, 'GROUND');
    await button(page, 'Take off').click();
    await untilState(page, 'FLYING');
    await tab(page, 'Checks').click();
    await page.keyboard.press('l');
    await page.waitForSelector('.land.answered', { timeout: 5000 });
    await tab(page, 'Fly').click();
    await untilState(page, 'GROUND');
  });

  it('with the radio cut repeats STOP until the radio is back, and tells in words what is wrong', async () => {
    await airborne('2×');
    await button(page, 'Cut radio').click();
    await page.keyboard.press('Escape');
    await page.waitForSelector('.stop.sent');
    await page.waitForFunction(() => document.body.innerText.includes('The vehicle flies on with its last reference'));
    await page.waitForTimeout(1500);
    await picture(page, 'radio-cut');
    await button(page, 'Mend radio').click();
    await page.waitForSelector('.stop.answered', { timeout: 5000 });
    await untilState(page, 'GROUND');
  });

  it('says which sensor is missing and what to do', async () => {
    await airborne('2×');
    await button(page, 'Unplug laser').click();
    await page.waitForFunction(() => document.body.innerText.includes('No fresh height'));
    expect(await body()).toContain('Check its start-up, sight and plug.');
    await picture(page, 'fault');
    await button(page, 'Plug laser in').click();
    await untilLaserIsOk(page);
    await button(page, 'Unplug IMU').click();
    await page.waitForFunction(() => document.body.innerText.includes('No fresh attitude'));
  });

  it('answers with its own table of parameters; what is out of range is refused before it is sent', async () => {
    page = await openPage(browser, site.url);
    await startVehicle(page, '5×');
    await tab(page, 'Parameters').click();
    await (await parameter(page, 'KP')).fill('1.5');
    expect(await page.getByRole('button', { name: /^Write changes/ }).isDisabled()).toBe(true);
    expect(await body()).toContain('Out of limits.');
    await (await parameter(page, 'KP')).fill('0.02');
    await (await parameter(page, 'LAW')).selectOption('PID');
    await page.getByLabel('Search', { exact: true }).fill('');
    await page.getByRole('button', { name: 'Write changes (2)' }).click();
    await picture(page, 'parameters');
    await button(page, 'Write now').click();
    await page.waitForFunction(() => document.body.innerText.includes('2 written.'));
    await button(page, 'Store on vehicle').click();
    await page.waitForFunction(() => document.body.innerText.includes('Stored on the vehicle.'));
    await page.getByLabel('KP', { exact: true }).fill('0.03');
    await page.getByRole('button', { name: 'Write changes (1)' }).click();
    await button(page, 'Write now').click();
    await page.waitForFunction(() => document.body.innerText.includes('not stored'));
    await button(page, 'Load stored').click();
    await page.waitForFunction(() => (document.querySelector('[aria-label=KP]') as HTMLInputElement).value === '0.02', undefined, { timeout: 30_000 });
  });

  it('hands over its flight recorder; rows that the radio lost are asked for again', async () => {
    const flown = join(mkdtempSync(join(tmpdir(), 'plomada-')), 'flight.csv');
    execFileSync(PLOMADA, ['fly', 'est-60cm-ramp', '--csv', flown]);
    await airborne('5×');
    await page.waitForTimeout(1000);
    await page.keyboard.press('l');
    await untilState(page, 'GROUND');
    await tab(page, 'Recorder').click();
    await button(page, 'Download everything').click();
    await page.waitForFunction(() => (document.querySelector('progress')?.value ?? 0) > 20);
    await tab(page, 'Fly').click();
    await button(page, 'Cut radio').click();
    await page.waitForTimeout(150);
    await button(page, 'Mend radio').click();
    await tab(page, 'Recorder').click();
    await page.waitForFunction(() => /\d+ rows, none missing/.test(document.body.innerText), undefined, { timeout: 50_000 });
    await page.waitForTimeout(300);
    await picture(page, 'recorder');
    const download = page.waitForEvent('download');
    await button(page, 'Save CSV').click();
    const csv = readFileSync(await (await download).path(), 'utf8').trim().split('\n');
    expect(`${csv[0]},height_m,abs_m,terrain_m,x_m,y_m,heading_rad`).toBe(readFileSync(flown, 'utf8').split('\n')[0]); // that of `fly --csv`, but for what only the simulation knows
    const times = csv.slice(1).map((row) => parseFloat(row));
    const steps = times.slice(1).map((t, i) => t - times[i]!);
    expect(Math.min(...steps)).toBeGreaterThan(0);
    expect(Math.max(...steps)).toBeLessThan(0.15); // a control cycle in 45 ms at most: none is missing
  });

  it('ticks its checklist, and a calibration ends at any key', async () => {
    page = await openPage(browser, site.url);
    await startVehicle(page, '5×');
    await tab(page, 'Checks').click();
    await page.getByLabel('Battery').fill('15.1');
    await page.getByLabel('I have done it').check();
    await page.waitForFunction(() => document.body.innerText.includes('Ready to fly'), undefined, { timeout: 40_000 });
    await picture(page, 'checks');
    await page.getByLabel('The vehicle is tied down').check();
    await button(page, 'Begin').click();
    await page.waitForSelector('.alarm');
    await page.waitForFunction(() => parseFloat(document.querySelector('.alarm .big-value')?.textContent ?? '0') > 0.3, undefined, { timeout: 40_000 });
    await page.keyboard.press('x');
    await page.waitForFunction(() => document.body.innerText.includes('Ended (a line came)'), undefined, { timeout: 10_000 });
    await tab(page, 'Fly').click();
    await page.waitForFunction(() => document.querySelectorAll('.big-value')[1]?.textContent === '0.0N', undefined, { timeout: 10_000 });
  });

  it('talks through the console, which remembers; a reload loses nothing', async () => {
    page = await openPage(browser, site.url);
    await startVehicle(page);
    await tab(page, 'Console').click();
    await page.locator('#command').fill('get kp');
    await page.keyboard.press('Enter');
    await page.waitForFunction(() => document.querySelector('.lines')!.textContent!.includes('OK KP 0.015'));
    expect(await page.locator('.lines').innerText()).not.toContain('alt:');
    await page.keyboard.press('ArrowUp');
    expect(await page.locator('#command').inputValue()).toBe('get kp');
    await picture(page, 'console');
    await page.locator('#command').fill('#PING last');
    await page.keyboard.press('Enter');
    await page.waitForFunction(() => document.querySelector('.lines')!.textContent!.includes('OK PING LAST') || document.querySelector('.lines')!.textContent!.includes('OK PING last'));
    await page.reload();
    await button(page, 'Close').click();
    await page.waitForFunction(() => document.body.innerText.includes('The page was reloaded.'));
    await tab(page, 'Console').click();
    expect((await page.locator('.lines').innerText()).toLowerCase()).toContain('ok ping last');
    const download = page.waitForEvent('download');
    await page.locator('.sessions').getByRole('button', { name: 'Save', exact: true }).first().click();
    expect(readFileSync(await (await download).path(), 'utf8')).toMatch(/^\d+ > #get kp$/m);
  });

  it('fits a phone held in the hand, in Spanish too', async () => {
    page = await openPage(browser, site.url, { width: 390, height: 844 });
    await startVehicle(page, '5×');
    await untilLaserIsOk(page);
    await button(page, 'Take off').click();
    await untilHeight(page, 0.6, 0.06);
    for (const language of ['Español', 'English']) {
      for (let view = 0; view < 6; view++) {
        await page.locator('nav button').nth(view).click();
        await page.waitForTimeout(100);
        expect(await page.evaluate(() => document.documentElement.scrollWidth), `${language}, view ${view}`).toBeLessThanOrEqual(390);
        for (const name of ['.stop', '.land']) expect(await page.locator(name).isVisible()).toBe(true);
      }
      await page.locator('nav button').first().click();
      await page.waitForTimeout(200);
      await picture(page, language === 'English' ? 'phone-es' : 'phone');
      await button(page, language).click();
    }
  });

  it('says nothing wrong to a screen reader, in either light', async () => {
    page = await openPage(browser, site.url);
    await startVehicle(page, '5×');
    await untilLaserIsOk(page);
    await page.addScriptTag({ path: join(ROOT, 'ground/node_modules/axe-core/axe.min.js') });
    for (let light = 0; light < 2; light++) {
      for (let view = 0; view < 6; view++) {
        await page.locator('nav button').nth(view).click();
        await page.waitForTimeout(300);
        const found = await page.evaluate(async () => {
          const { violations } = await (window as unknown as { axe: { run(): Promise<{ violations: { id: string; nodes: { html: string }[] }[] }> } }).axe.run();
          return violations.map((v) => `${v.id}: ${v.nodes.map((node) => node.html.slice(0, 120)).join(' | ')}`);
        });
        expect(found, `light ${light}, view ${view}`).toEqual([]);
      }
      await page.getByRole('button', { name: 'Light or dark' }).click();
    }
  });

  it('keeps its memory and its frames while it plots', async () => {
    const minutes = Number(process.env.MINUTES ?? 1); // of flight, at five times the speed
    await airborne('5×');
    const cdp = await page.context().newCDPSession(page);
    const heap = async (): Promise<number> => {
      await cdp.send('HeapProfiler.collectGarbage');
      const { usedSize } = await cdp.send('Runtime.getHeapUsage');
      return usedSize / 1e6;
    };
    await page.evaluate(() => {
      const spent: number[] = [];
      (window as unknown as { spent: number[] }).spent = spent;
      const original = window.requestAnimationFrame.bind(window);
      window.requestAnimationFrame = (callback) => original((t) => {
        const begin = performance.now();
        callback(t);
        spent.push(performance.now() - begin);
        if (spent.length > 20_000) spent.splice(0, 10_000);
      });
    });
    await page.waitForTimeout(4000);
    const before = await heap();
    await page.waitForTimeout((minutes * 60_000) / 5);
    const after = await heap();
    const frames = (await page.evaluate(() => (window as unknown as { spent: number[] }).spent)).sort((a, b) => a - b);
    const high = frames[Math.floor(frames.length * 0.95)]!;
    console.log(`memory ${before.toFixed(1)} to ${after.toFixed(1)} MB in ${minutes} min of flight; frames: ${frames.length}, median ${frames[frames.length >> 1]!.toFixed(1)} ms, 95 % under ${high.toFixed(1)} ms`);
    expect(after - before).toBeLessThan(3);
    expect(high).toBeLessThan(16);
    expect(await big(page, 0).textContent()).toMatch(/^0\.\d\dm$/);
  }, 30 * 60_000);
});

describe('the bundle', () => {
  it('is at most 1 MB without the vehicle, and tells the licence of all that it contains', () => {
    const size = ['index.html', 'ground.js'].reduce((sum, name) => sum + statSync(join(ROOT, 'build-ground', name)).size, 0);
    expect(size).toBeLessThan(1_000_000);
    const licences = readFileSync(join(ROOT, 'build-ground/LICENCES.txt'), 'utf8');
    for (const name of ['preact', '@preact/signals', 'uplot', 'wasi-libc']) expect(licences).toContain(name);
    expect(readFileSync(join(ROOT, 'build-ground/ground.js'), 'utf8')).not.toMatch(/https?:\/\/(?!localhost|www\.w3\.org)[a-z]/);
  });
});
