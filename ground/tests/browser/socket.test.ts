import { join } from 'node:path';
import type { Browser, Page } from 'playwright-core';
import { afterAll, beforeAll, describe, expect, it } from 'vitest';
import { button, openBrowser, openPage, freePort, ROOT, serveSite, startBoard, tab, untilLaserIsOk, untilState, type Board, type Site } from './rig';

let browser: Browser;
let site: Site;
let page: Page;
let board: Board;

beforeAll(async () => {
  site = await serveSite();
  browser = await openBrowser();
  board = await startBoard(`${await freePort()}`);
});
afterAll(async () => {
  await browser?.close();
  await board?.stop();
  site?.close();
});

async function connect(on: Page): Promise<void> {
  await on.getByLabel('Address').fill(board.address);
  await button(on, 'Connect').click();
}

describe('by WebSocket, the unmodified firmware in a program of its own', () => {
  it('gives a late client nothing stale, its answers, and its laser after the wait', async () => {
    await new Promise((done) => setTimeout(done, 4000)); // twenty lines that nobody reads
    page = await openPage(browser, site.url);
    const begin = Date.now();
    await connect(page);
    await page.waitForFunction(() => document.querySelectorAll('.big-value')[2]?.textContent === 'GROUND');
    await tab(page, 'Console').click();
    await page.getByLabel('Show telemetry').check();
    const lines = await page.locator('.lines div').count();
    expect(lines).toBeLessThanOrEqual((Date.now() - begin) / 200 + 2); // five a second, and none of the twenty
    await page.locator('#command').fill('#LASER');
    await page.keyboard.press('Enter');
    await page.waitForFunction(() => document.querySelector('.lines')!.textContent!.includes('OK LASER state:'));
    await tab(page, 'Fly').click();
    await untilLaserIsOk(page);
  });

  it('refuses a second tab in plain words', async () => {
    const other = await openPage(browser, site.url);
    await connect(other);
    await other.waitForFunction(() => document.body.innerText.includes('or another tab has it'));
    await other.close();
  });

  it('is told by the firmware that it wants sums, also when another page has switched them on', async () => {
    await tab(page, 'Console').click();
    await page.locator('#command').fill('#SUM ON');
    await page.keyboard.press('Enter');
    await page.waitForFunction(() => document.querySelector('.lines')!.textContent!.includes('OK SUM ON'));
    await page.evaluate(() => localStorage.clear()); // a browser that has never been here
    await page.reload();
    await connect(page);
    await tab(page, 'Console').click();
    await page.waitForFunction(() => /#GET LINK\*[0-9A-F]{4}/.test(document.querySelector('.lines')!.textContent!) && document.querySelector('.lines')!.textContent!.includes('OK LINK 0'));
    expect(await page.getByLabel('A sum on every line').isChecked()).toBe(true);
    await page.locator('#command').fill('#SUM OFF');
    await page.keyboard.press('Enter');
    await page.waitForFunction(() => document.querySelector('.lines')!.textContent!.includes('OK SUM OFF'));
    await tab(page, 'Fly').click();
  });

  it('comes back after a reload in flight, which it asks about first, and lands; says so when the program ends', async () => {
    await untilLaserIsOk(page);
    await page.locator('.go').click();
    await untilState(page, 'FLYING');
    const asked: string[] = [];
    page.on('dialog', (dialog) => { asked.push(dialog.type()); void dialog.accept(); });
    await page.reload();
    expect(asked).toEqual(['beforeunload']);
    await page.waitForFunction(() => document.body.innerText.includes('The page was reloaded.'));
    await connect(page);
    await untilState(page, 'FLYING');
    await page.keyboard.press('l');
    await page.waitForSelector('.land.answered');
    await untilState(page, 'GROUND');
    await board.stop();
    await page.waitForFunction(() => document.body.innerText.includes('The simulation has ended or the connection broke.'));
    expect(await page.locator('.status').innerText()).toContain('Link lost');
    expect(await page.locator('.stop').isDisabled()).toBe(true);
  });

  it('says in plain words that nobody answers', async () => {
    await button(page, 'Connect again').click();
    await connect(page);
    await page.waitForFunction(() => document.body.innerText.includes('Nobody answers at this address'));
  });
});

describe('whose page may fly the simulation', () => {
  const origins: [string, (site: Site) => string][] = [
    ['of a stranger’s site', (at) => at.url.replace('localhost', 'strange.example')],
    ['that was opened from a disk, whose origin is anybody’s', () => `file://${join(ROOT, 'build-ground/index.html')}`],
  ];
  for (const [what, url] of origins) {
    it(`a page ${what} needs the address that the program printed`, async () => {
      const own = await startBoard(`${await freePort()}`);
      const elsewhere = await openBrowser(undefined, '--host-resolver-rules=MAP strange.example 127.0.0.1');
      try {
        const other = await openPage(elsewhere, url(site));
        await other.getByLabel('Address').fill(own.address.replace(/\/[0-9a-f]+$/, ''));
        await button(other, 'Connect').click();
        await other.waitForFunction(() => document.body.innerText.includes('needs the whole address that the command prints'));
        await other.getByLabel('Address').fill(own.address);
        await button(other, 'Connect').click();
        await untilState(other, 'GROUND');
      } finally {
        await elsewhere.close();
        await own.stop();
      }
    });
  }

  it('a page of this machine needs the port only', async () => {
    const own = await startBoard(`${await freePort()}`);
    const other = await openPage(browser, site.url);
    await other.getByLabel('Address').fill(own.address.replace(/\/[0-9a-f]+$/, ''));
    await button(other, 'Connect').click();
    await untilState(other, 'GROUND');
    await other.context().close();
    await own.stop();
  });
});
