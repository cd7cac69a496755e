import type { Browser, Page } from 'playwright-core';
import { afterAll, beforeAll, describe, expect, it } from 'vitest';
import { button, leftOut, openPage, serialBrowser, serveSite, startBoard, tab, whyNoSerial, type Board, type Site } from './rig';

const why = whyNoSerial();
let browser: Browser;
let site: Site;
let page: Page;
let board: Board;

describe.skipIf(leftOut(why))(`by Web Serial, the unmodified firmware on a pseudo-terminal in place of ttyS0${why ? ` (not here: ${why})` : ''}`, () => {
  beforeAll(async () => {
    site = await serveSite();
    board = await startBoard('pty');
    browser = await serialBrowser(board.address, site.url);
  });
  afterAll(async () => {
    await browser?.close();
    await board?.stop();
    site?.close();
  });

  it('opens the port that it may use without asking, and the firmware answers', async () => {
    page = await openPage(browser, site.url);
    await button(page, 'Open the port used last').click();
    await page.waitForFunction(() => document.querySelectorAll('.big-value')[2]?.textContent === 'GROUND', undefined, { timeout: 10_000 });
    await tab(page, 'Console').click();
    await page.locator('#command').fill('#GET KP');
    await page.keyboard.press('Enter');
    await page.waitForFunction(() => document.querySelector('.lines')!.textContent!.includes('OK KP 0.015'));
  });

  it('tells a second tab that the first one has the radio', async () => {
    const other = await page.context().newPage();
    await other.goto(site.url);
    await button(other, 'Open the port used last').click();
    await other.waitForFunction(() => document.body.innerText.includes('Another tab of this page has the radio.'));
    await other.close();
  });

  it('says so in plain words when the adapter is pulled out', async () => {
    await board.stop();
    await page.waitForFunction(() => document.body.innerText.includes('The adapter was pulled out'), undefined, { timeout: 10_000 });
    expect(await page.locator('.status').innerText()).toContain('Link lost');
  });
});
