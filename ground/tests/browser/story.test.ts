import { execFileSync } from 'node:child_process';
import { mkdtempSync, readFileSync } from 'node:fs';
import { tmpdir } from 'node:os';
import { join } from 'node:path';
import type { Browser, Page } from 'playwright-core';
import { afterAll, afterEach, beforeAll, describe, expect, it } from 'vitest';
import { readCsv } from '../../src/protocol/logs';
import { story } from '../../src/story';
import { button, openBrowser, openPage, picture, PLOMADA, ROOT, serveSite, startVehicle, tab, untilHeight, untilLaserIsOk, untilState, type Site } from './rig';

let browser: Browser;
let site: Site;
let page: Page;
const csv = join(mkdtempSync(join(tmpdir(), 'plomada-story-')), 'three.csv');

beforeAll(async () => {
  execFileSync(PLOMADA, ['fly', 'est-60cm-ramp', '--set', 'LAYOUT=THREE', '--csv', csv], { stdio: 'ignore' });
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

const marks = () => page.locator('.story-mark');
const line = (): Promise<string> => page.locator('.story-line').first().innerText();

async function replay(locale = 'en-GB', close = 'Close', view = 'Replay', open = 'Open a file'): Promise<void> {
  page = await openPage(browser, site.url, { locale });
  await button(page, close).click();
  await tab(page, view).click();
  const chooser = page.waitForEvent('filechooser');
  await button(page, open).click();
  await (await chooser).setFiles(csv);
  await page.waitForSelector('.story-mark', { timeout: 20_000 });
}

describe('the story of a flight on its curve', () => {
  it('marks each event where it happened, and the mouse reads its sentence', async () => {
    await replay();
    const recording = readCsv(readFileSync(csv, 'utf8'), 'x');
    const events = story(recording, 'en');
    expect(events.map((event) => event.kind)).toContain('out');
    await expect.poll(() => marks().count()).toBe(events.length);
    const plot = (await page.locator('.u-over').first().boundingBox())!;
    const first = recording.time[0]!;
    const last = recording.time[recording.time.length - 1]!;
    for (const [i, event] of events.entries()) {
      const before = events.slice(0, i).filter((other) => other.text === event.text && other.kind === event.kind).length;
      const mark = page.locator(`.story-mark[aria-label="${event.text}"][data-kind="${event.kind}"]`).nth(before);
      const box = (await mark.boundingBox())!;
      const at = first + ((box.x + box.width / 2 - plot.x) / plot.width) * (last - first);
      expect(Math.abs(at - event.t), event.text).toBeLessThan(0.15);
      await mark.hover();
      expect(await line()).toBe(event.text);
    }
    expect(events.filter((event) => event.kind === 'down').map((event) => event.text)).toEqual([expect.stringMatching(/^An edge: the ground falls away by 0\.2[456] m\.$/)]); // 0.25 m, as the mirrors measure it
    await picture(page, 'story', '.plot >> nth=0');
  });

  it('is read by the keyboard alone: one Tab, then the arrow keys', async () => {
    await replay();
    const texts = story(readCsv(readFileSync(csv, 'utf8'), 'x'), 'en').map((event) => event.text);
    expect(await page.locator('.story-mark[tabindex="0"]').count()).toBe(1);
    for (let i = 0; i < 60 && !(await page.evaluate(() => document.activeElement?.classList.contains('story-mark'))); i++) await page.keyboard.press('Tab');
    expect(await line()).toBe(texts[0]);
    const read = [await line()];
    for (let i = 1; i < texts.length; i++) {
      await page.keyboard.press('ArrowRight');
      read.push(await line());
    }
    expect(read.sort()).toEqual([...texts].sort());
    await page.keyboard.press('ArrowRight'); // there is none behind the last
    expect(await line()).toBe(texts[texts.length - 1]);
    await page.keyboard.press('Home');
    expect(await line()).toBe(texts[0]);
    await page.keyboard.press('Tab'); // and out again
    expect(await page.evaluate(() => document.activeElement?.classList.contains('story-mark'))).toBe(false);
  });

  it('is told in Spanish too, with a decimal comma', async () => {
    await replay('es-ES', 'Cerrar', 'Repetición', 'Abrir un fichero');
    await page.locator('.story-mark.down').hover();
    expect(await line()).toMatch(/^Un borde: el suelo se aleja 0,2[456] m\.$/);
  });

  it('is told by the page beside the picture of `make plot` in the same words, by mouse and keyboard', async () => {
    const html = csv.replace('.csv', '.html');
    execFileSync(join(ROOT, 'build/venv/bin/python'), ['-B', join(ROOT, 'tools/plot/plot.py'), csv]);
    page = await openPage(browser, `file://${html}`);
    const texts = story(readCsv(readFileSync(csv, 'utf8'), 'x'), 'en').map((event) => `${event.t.toFixed(1)} s: ${event.text}`);
    const all = page.locator('figure button');
    expect(await all.evaluateAll((buttons) => buttons.map((mark) => mark.getAttribute('aria-label')))).toEqual(texts);
    for (let i = 0; i < texts.length; i++) {
      await all.nth(i).hover();
      expect(await page.locator('#said').innerText()).toBe(texts[i]);
    }
    await page.locator('h1').hover();
    await page.keyboard.press('Tab');
    expect(await page.locator('#said').innerText()).toBe(texts[0]);
    await page.keyboard.press('ArrowRight');
    expect(await page.locator('#said').innerText()).toBe(texts[1]);
    await page.keyboard.press('End');
    expect(await page.locator('#said').innerText()).toBe(texts[texts.length - 1]);
    expect(await page.locator('li.pointed').innerText()).toBe(texts[texts.length - 1]);
  });

  it('is told while it flies', async () => {
    page = await openPage(browser, site.url);
    await startVehicle(page, '5×');
    await untilLaserIsOk(page);
    expect(await marks().count()).toBe(0);
    await button(page, 'Take off').click();
    await untilHeight(page, 0.6, 0.05);
    await page.locator('.story-mark.takeoff').hover();
    expect(await line()).toBe('Take-off to 0.60 m.');
    await button(page, 'Unplug laser').click();
    await page.waitForSelector('.story-mark.state', { timeout: 20_000 });
    await untilState(page, 'GROUND');
    await page.waitForSelector('.story-mark.landed');
    const told = await marks().evaluateAll((all) => all.map((mark) => mark.getAttribute('aria-label')));
    expect(told).toContain('The height is lost: it holds its thrust.');
    expect(told).toContain('It is on the ground.');
  });
});
