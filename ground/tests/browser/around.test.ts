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
/** Walls 1.5 m to the right and 2.5 m ahead: tests/fixtures/around/vectors.txt. */
const CORNER = 'w:-2sstttrponmlkkj-4jkklmnoprtwz..-c';

/** A vehicle that says these lines, five times a second. */
async function tells(lines: () => string[]): Promise<string[]> {
  const asked: string[] = [];
  vehicle = await scripted((line, say) => {
    asked.push(line);
    if (line === '#GET LINK') say('OK LINK 0');
    else if (line === '#HELP' || line === '#GET') say(`OK ${line.slice(1)} END lines:0`);
    else if (line.startsWith('#WALLS')) say('ERR WALLS unknown command');
  });
  timer = setInterval(() => {
    vehicle?.say(TELEMETRY);
    for (const line of lines()) vehicle?.say(line);
  }, 200);
  page = await openPage(browser, site.url);
  await page.getByLabel('Address').fill(vehicle.url);
  await button(page, 'Connect').click();
  return asked;
}

const sector = (index: number, kind: string): Promise<unknown> => page.waitForSelector(`.sector[data-sector="${index}"][data-kind="${kind}"]`, { timeout: 15_000 });
const kinds = (kind: string): Promise<number> => page.locator(`.sector.${kind}`).count();
const card = (): Promise<string> => page.locator('.around').innerText();

describe('the picture of what stands around', () => {
  it('shows what was met where it is, empty sectors as empty, and those that nobody looks into as such', async () => {
    await tells(() => [CORNER, 'drift:90,150,20,5/0,250,40,5']);
    await sector(20, 'met');
    expect(await kinds('met')).toBe(26);
    expect(await kinds('nothing')).toBe(2);
    expect(await kinds('unseen')).toBe(44);
    const fill = (kind: string): Promise<string> => page.locator(`.sector.${kind}`).first().evaluate((shape) => getComputedStyle(shape).fill);
    expect(await fill('unseen')).toContain('unseen'); // hatched
    expect(await fill('nothing')).toBe('none');
    expect(await fill('met')).toMatch(/^rgb/);
    // sector 20 looks to the right: the nearest corner of its shape lies right of the middle, at 1481 of 4100 mm
    expect(await page.locator('.sector[data-sector="20"]').getAttribute('data-mm')).toBe('1481');
    const [x, y] = (await page.locator('.sector[data-sector="20"]').getAttribute('points'))!.split(' ')[0]!.split(',').map(Number);
    expect(Math.hypot(x! - 110, y! - 110)).toBeCloseTo((1481 / 4100) * 104, 0);
    expect(x!).toBeGreaterThan(140);
    expect(await card()).toMatch(/Nearest: 1\.48 m, \d+° from the nose, clockwise · Age: 0\.\d s/);
    expect(await card()).toContain('0.45 ± 0.05 m/s over the floor, towards 27°');
    expect(await page.locator('.around [role=alert]').count()).toBe(0);
    await picture(page, 'around', '.around');
  });

  it('warns of what comes near, and stops when it is told no more', async () => {
    let near = ' near:45,120,60';
    await tells(() => [CORNER + near]);
    await page.waitForSelector('.around [role=alert]');
    expect(await page.locator('.around [role=alert]').innerText()).toBe('Something comes near: 1.20 m off at 45°, 0.60 m/s');
    expect(await page.locator('.comes').count()).toBe(1);
    near = '';
    await page.waitForFunction(() => document.querySelector('.around [role=alert]') === null);
  });

  it('forgets everything, a warning too, when nothing more comes', async () => {
    let on = true;
    await tells(() => (on ? [`${CORNER} near:45,120,60`, 'drift:90,150,20,5'] : []));
    await sector(20, 'met');
    on = false;
    await page.waitForFunction(() => document.querySelectorAll('.sector.met').length === 0);
    expect(await kinds('unseen')).toBe(72);
    expect(await page.locator('.around [role=alert]').count()).toBe(0);
    expect(await card()).toContain('nothing is known of now');
    await page.waitForFunction(() => document.querySelector('.drift')?.textContent?.includes('no wall tells it'));
  });

  it('takes a torn line for none, and keeps what it knew until that is old', async () => {
    let line = CORNER;
    await tells(() => [line]);
    await sector(20, 'met');
    line = CORNER.slice(0, 20);
    await page.waitForFunction(() => document.querySelectorAll('.sector.met').length === 0);
    expect(await kinds('unseen')).toBe(72);
  });

  it('says that no ray looks around with one mirror', async () => {
    await tells(() => ['w:-z-B', 'drift:-']);
    await page.waitForFunction(() => document.querySelector('.around .banner')?.textContent?.includes('LAYOUT THREE'));
    expect(await card()).toContain('Speed by the walls: no wall tells it');
  });

  it('asks for it at a button, says what the firmware answers, and is not there for one that tells nothing of its scans', async () => {
    const asked = await tells(() => ['mf:35,776,9,83,- m1:- m2:- out:-']);
    await button(page, 'Show what stands around').click();
    await expect.poll(() => asked).toContain('#WALLS ON');
    await page.waitForFunction(() => document.querySelector('.around [role=alert]')?.textContent?.includes('unknown command'));
    vehicle?.end();
    if (timer) clearInterval(timer);
    await page.context().close();
    vehicle = await scripted((line, say) => { if (line === '#GET LINK') say('OK LINK 0'); else if (line === '#HELP' || line === '#GET') say(`OK ${line.slice(1)} END lines:0`); });
    timer = setInterval(() => vehicle?.say(TELEMETRY), 200);
    page = await openPage(browser, site.url);
    await page.getByLabel('Address').fill(vehicle.url);
    await button(page, 'Connect').click();
    await page.waitForFunction(() => document.querySelectorAll('.big-value')[2]?.textContent === 'FLYING');
    await page.waitForTimeout(1500);
    expect(await page.locator('.around').count()).toBe(0);
  });

  it('is that of the unmodified firmware: 29 sectors with three mirrors, none with one', async () => {
    page = await openPage(browser, site.url);
    await startVehicle(page, '5×');
    await untilLaserIsOk(page);
    await button(page, 'Show what stands around').click();
    await expect.poll(async () => (await kinds('met')) + (await kinds('nothing')), { timeout: 20_000 }).toBe(29);
    await tab(page, 'Console').click();
    await page.getByLabel('Type a command').fill('#LAYOUT FRONT');
    await page.keyboard.press('Enter');
    await tab(page, 'Fly').click();
    await expect.poll(() => kinds('unseen'), { timeout: 20_000 }).toBe(72);
  });
});
