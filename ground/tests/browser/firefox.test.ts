import type { Browser, Page } from 'playwright-core';
import { afterAll, afterEach, beforeAll, describe, expect, it } from 'vitest';
import { button, FIREFOX, freePort, leftOut, openFirefox, openPage, serveSite, startBoard, startVehicle, tab, untilHeight, untilLaserIsOk, untilState, type Board, type Site } from './rig';

let browser: Browser;
let site: Site;
let page: Page;
let board: Board | null = null;

describe.skipIf(leftOut(FIREFOX === null ? 'no Firefox' : null))(`in Firefox, by WebDriver BiDi${FIREFOX === null ? ' (not here: no Firefox)' : ''}`, () => {
  beforeAll(async () => {
    site = await serveSite();
    browser = await openFirefox();
  });
  afterAll(async () => {
    await browser?.close();
    await board?.stop();
    site?.close();
  });
  afterEach(async () => {
    await page?.context().close();
  });

  it('the simulated vehicle is flown, stopped, and hands over its flight recorder', async () => {
    page = await openPage(browser, site.url);
    expect(await page.evaluate(() => navigator.userAgent)).toContain('Firefox');
    await startVehicle(page, '5×');
    await untilLaserIsOk(page);
    await button(page, 'Take off').click();
    await untilHeight(page, 0.6, 0.06);
    await page.keyboard.press('Escape');
    await page.waitForSelector('.stop.answered');
    await untilState(page, 'GROUND');
    await tab(page, 'Recorder').click();
    await button(page, 'Last 20 s').click();
    await page.waitForFunction(() => /\d+ rows, none missing/.test(document.body.innerText), undefined, { timeout: 50_000 });
  });

  it('a program of its own is reached by WebSocket, and its end is told', async () => {
    board = await startBoard(`${await freePort()}`);
    page = await openPage(browser, site.url);
    await page.getByLabel('Address').fill(board.address);
    await button(page, 'Connect').click();
    await untilState(page, 'GROUND');
    await tab(page, 'Parameters').click();
    await page.waitForSelector('.group', { timeout: 30_000 });
    await board.stop();
    await page.waitForFunction(() => document.body.innerText.includes('The simulation has ended or the connection broke.'));
  });

  it('has Web Serial, whose list of ports nobody can click here', async () => {
    page = await openPage(browser, site.url);
    expect(await page.evaluate(() => 'serial' in navigator)).toBe(true);
  });
});
