import type { Browser, Page } from 'playwright-core';
import { afterAll, afterEach, beforeAll, describe, expect, it } from 'vitest';
import { button, openBrowser, openPage, picture, serveSite, startVehicle, tab, untilLaserIsOk, type Site } from './rig';
import { scripted, type Scripted } from './script';

let browser: Browser;
let site: Site;
let page: Page;
let vehicle: Scripted | null = null;
let timer: NodeJS.Timeout | null = null;

beforeAll(async () => {
  site = await serveSite();
  browser = await openBrowser();
});
afterAll(async () => {
  await browser?.close();
  site?.close();
});
afterEach(async () => {
  if (timer) clearInterval(timer);
  timer = null;
  vehicle?.end();
  vehicle = null;
  await page?.context().close();
});

const TELEMETRY = 'alt:0.598 ref:0.600 laser:OK thr:7.12 state:FLYING flags:0';

/** A vehicle that says these two lines, five times a second. */
async function tells(beams: () => string | null, telemetry = TELEMETRY): Promise<void> {
  vehicle = await scripted((line, say) => {
    if (line === '#GET LINK') say('OK LINK 0');
    else if (line === '#HELP' || line === '#GET') say(`OK ${line.slice(1)} END lines:0`);
  });
  timer = setInterval(() => {
    vehicle?.say(telemetry);
    const line = beams();
    if (line !== null) vehicle?.say(line);
  }, 200);
  page = await openPage(browser, site.url);
  await page.getByLabel('Address').fill(vehicle.url);
  await button(page, 'Connect').click();
}

const judged = (mirror: string, as: string): Promise<unknown> => page.waitForSelector(`.fan[data-mirror="${mirror}"][data-judgement="${as}"]`, { timeout: 15_000 });
const row = (mirror: string): Promise<string> => page.locator(`.beams tr[data-mirror="${mirror}"]`).innerText();
const rays = (mirror: string): Promise<number> => page.locator(`.fan[data-mirror="${mirror}"] .ray`).count();

describe('the picture of the scan', () => {
  it('shows with one mirror the two others as not known, and no number of them', async () => {
    await tells(() => 'mf:35,776,9,83,- m1:- m2:- out:-');
    await judged('mf', 'good');
    expect(await rays('mf')).toBe(35);
    for (const mirror of ['m1', 'm2']) {
      await judged(mirror, 'unknown');
      expect(await rays(mirror)).toBe(0);
      expect(await row(mirror)).toContain('not known');
      expect(await row(mirror)).not.toMatch(/\s\d/);
    }
    expect(await row('mf')).toMatch(/35\s+776\s+9\s+83\s+–/); // one mirror: nobody asks whether it lies
  });

  it('tells a liar, a mirror that sees other ground, one that sees nothing, and wide rays from each other', async () => {
    let line = 'mf:8,776,9,83,0 m1:8,131,4,108,99 m2:1,-,-,-,25 out:m1';
    await tells(() => line, `${TELEMETRY} doubt:SIGHT/blind`);
    await judged('m1', 'liar');
    await judged('m2', 'blind');
    expect(await row('m1')).toMatch(/108\s+99$/);
    expect(await row('m2')).toMatch(/1\s+–\s+–\s+–\s+25$/);
    expect(await page.locator('.beams .banner').innerText()).toContain('SIGHT/blind: no mirror is believed: the vehicle moves, and their slants do not follow.');
    await picture(page, 'beams', '.beams');
    line = 'mf:8,805,159,83,0 m1:8,807,6,108,0 m2:8,557,8,58,3 out:m2';
    await judged('mf', 'wide');
    await judged('m1', 'good');
    await judged('m2', 'out');
  });

  it('names the limit that holds the thrust', async () => {
    await tells(() => 'mf:35,776,9,83,- m1:- m2:- out:-', `${TELEMETRY} limit:CLIMB`);
    await judged('mf', 'good');
    expect(await page.locator('.beams .banner').innerText()).toContain('CLIMB: no height has confirmed the climb');
  });

  it('forgets what it showed when nothing more comes of the scans', async () => {
    let on = true;
    await tells(() => (on ? 'mf:35,776,9,83,- m1:- m2:- out:-' : null));
    await judged('mf', 'good');
    on = false;
    await judged('mf', 'unknown');
    expect(await row('mf')).not.toContain('776');
    expect(await page.locator('.beams').innerText()).toContain('nothing is known of now');
  });

  it('is not there for a firmware that tells nothing of its scans', async () => {
    await tells(() => null);
    await page.waitForFunction(() => document.querySelectorAll('.big-value')[2]?.textContent === 'FLYING');
    await page.waitForTimeout(1500);
    expect(await page.locator('.beams').count()).toBe(0);
  });

  it('is that of the unmodified firmware, with three mirrors and with one', async () => {
    page = await openPage(browser, site.url);
    await startVehicle(page, '5×');
    await untilLaserIsOk(page);
    for (const [layout, others, count] of [['THREE', 'good', 8], ['FRONT', 'unknown', 35]] as const) {
      await tab(page, 'Console').click();
      await page.getByLabel('Type a command').fill(`#LAYOUT ${layout}`);
      await page.keyboard.press('Enter');
      await tab(page, 'Fly').click();
      await judged('m1', others);
      await judged('m2', others);
      await judged('mf', 'good');
      await expect.poll(() => rays('mf')).toBe(count);
      const slant = Number(await page.locator('.fan[data-mirror="mf"]').getAttribute('data-slant'));
      expect(slant).toBeGreaterThan(190); // it stands: 105 mm to the mirror, 100 mm down
      expect(slant).toBeLessThan(225);
    }
  });
});
