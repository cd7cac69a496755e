import { readFileSync } from 'node:fs';
import type { Browser, BrowserContext, Page } from 'playwright-core';
import { afterAll, afterEach, beforeAll, describe, expect, it } from 'vitest';
import { button, openBrowser, serveSite, startVehicle, tab, untilLaserIsOk, untilState, type Site } from './rig';

let browser: Browser;
let site: Site;
let context: BrowserContext;
let errors: string[];

beforeAll(async () => {
  site = await serveSite();
  browser = await openBrowser();
});
afterAll(async () => {
  await browser?.close();
  site?.close();
});
afterEach(async () => {
  await context?.close();
});

async function begin(): Promise<void> {
  context = await browser.newContext({ viewport: { width: 1280, height: 800 }, locale: 'en-GB', acceptDownloads: true });
  errors = [];
}

async function open(): Promise<Page> {
  const page = await context.newPage();
  page.on('pageerror', (error) => errors.push(String(error)));
  await page.goto(site.url);
  return page;
}

async function flies(page: Page): Promise<void> {
  await startVehicle(page, '5×');
  await untilLaserIsOk(page);
  await button(page, 'Take off').click();
  await untilState(page, 'FLYING');
  await page.keyboard.press('Escape');
  await page.waitForSelector('.stop.answered');
}

async function type(page: Page, line: string): Promise<void> {
  await page.locator('#command').fill(line);
  await page.keyboard.press('Enter');
}

/** The newest session as the console saves it. */
async function savedLines(page: Page): Promise<string[]> {
  await page.getByRole('button', { name: '↻' }).click();
  await page.waitForTimeout(300);
  const download = page.waitForEvent('download');
  await page.locator('.sessions').getByRole('button', { name: 'Save', exact: true }).first().click();
  return readFileSync(await (await download).path(), 'utf8').trim().split('\n');
}

const twice = (lines: string[]): string[] => lines.filter((line, i) => lines.indexOf(line) !== i);
const pings = (lines: string[]): string[] => lines.map((line) => /> #PING (\d+)$/.exec(line)?.[1]).filter((n) => n !== undefined);

describe('whatever this browser has kept', () => {
  it('nonsense in every place is no condition for flying', async () => {
    await begin();
    const page = await open();
    await page.waitForSelector('.sheet');
    await page.evaluate(async () => {
      for (const name of ['history', 'sums', 'theme', 'language', 'reference', 'port', 'link.simulated vehicle', 'cells', 'tail.123', 'tail.', 'tail.x']) localStorage.setItem(`plomada.${name}`, '{"NaN');
      localStorage.setItem('plomada.tail.77', '[null, 3]');
      const database = await new Promise<IDBDatabase>((done) => { const request = indexedDB.open('plomada-ground', 1); request.onsuccess = () => done(request.result); });
      const transaction = database.transaction(['sessions', 'batches'], 'readwrite');
      transaction.objectStore('sessions').put({ id: 'not a number' });
      transaction.objectStore('sessions').put({ id: 9e15, link: 7 });
      transaction.objectStore('sessions').put({ id: Date.now(), link: 'x', lines: 3, last: Date.now() });
      transaction.objectStore('batches').put({ session: 9e15, number: 0, entries: 7 });
      await new Promise((done) => (transaction.oncomplete = done));
    });
    await page.reload();
    expect(await page.locator('.stop').isVisible()).toBe(true);
    await flies(page);
    await tab(page, 'Console').click();
    expect(pings(await savedLines(page))).toEqual([]);
    await page.waitForFunction(() => /records of the kept sessions are damaged/.test(document.body.innerText));
    expect(errors).toEqual([]);
  });

  it('a batch that is none does not hide the page after a reload', async () => {
    await begin();
    const page = await open();
    await startVehicle(page);
    await tab(page, 'Console').click();
    await type(page, '#PING 1');
    await page.waitForTimeout(2500);
    await page.evaluate(async () => {
      const database = await new Promise<IDBDatabase>((done) => { const request = indexedDB.open('plomada-ground', 1); request.onsuccess = () => done(request.result); });
      const transaction = database.transaction(['sessions', 'batches'], 'readwrite');
      const key = (await new Promise<IDBValidKey[]>((done) => { const request = transaction.objectStore('sessions').getAllKeys(); request.onsuccess = () => done(request.result); })).at(-1)!;
      transaction.objectStore('batches').put({ session: key, number: 500 });
      transaction.objectStore('batches').put({ session: key, number: 501, entries: [null, { t: 'x' }, 'y'] });
      await new Promise((done) => (transaction.oncomplete = done));
    });
    await page.reload();
    await page.waitForFunction(() => document.body.innerText.includes('The page was reloaded.'));
    expect(await page.locator('.stop').isVisible()).toBe(true);
    expect(errors).toEqual([]);
  });

  for (const [what, script] of [
    ['a database of another shape', 'indexedDB.open("plomada-ground", 1)'],
    ['a database of a newer page', 'indexedDB.open("plomada-ground", 9)'],
  ] as const) {
    it(`${what} is no condition for flying, and the session can be saved`, async () => {
      await begin();
      await context.route('**/empty', (route) => route.fulfill({ contentType: 'text/html', body: '<p>' }));
      const page = await context.newPage();
      page.on('pageerror', (error) => errors.push(String(error)));
      await page.goto(`${site.url}/empty`);
      await page.evaluate(`new Promise((done) => { const r = ${script}; r.onsuccess = () => { r.result.close(); done(); }; })`);
      await page.goto(site.url);
      await flies(page);
      await tab(page, 'Console').click();
      await type(page, '#PING 5');
      await page.waitForTimeout(1500);
      const lines = await savedLines(page);
      expect(pings(lines)).toEqual(['5']);
      expect(twice(lines)).toEqual([]);
      expect(errors).toEqual([]);
    });
  }

  it('a browser that refuses to keep anything lets fly, and says that the log is in this page only', async () => {
    await begin();
    await context.addInitScript(() => {
      for (const name of ['localStorage', 'indexedDB']) Object.defineProperty(window, name, { get() { throw new DOMException('denied', 'SecurityError'); } });
    });
    const page = await open();
    await flies(page);
    await page.waitForFunction(() => document.body.innerText.includes('The browser refuses to keep the log'));
    await tab(page, 'Console').click();
    await type(page, '#PING 6');
    await page.waitForTimeout(500);
    expect(pings(await savedLines(page))).toEqual(['6']);
    expect(errors).toEqual([]);
  });

  it('a view that cannot be drawn leaves STOP and LAND where they are', async () => {
    await begin();
    const page = await open();
    await startVehicle(page, '5×');
    await untilLaserIsOk(page);
    await button(page, 'Take off').click();
    await untilState(page, 'FLYING');
    await page.evaluate(() => { Date.prototype.toISOString = () => { throw new RangeError('a broken console'); }; });
    await tab(page, 'Console').click();
    await page.waitForFunction(() => document.body.innerText.includes('This view cannot be drawn.'));
    await page.locator('.stop').click();
    await page.waitForSelector('.stop.answered');
    await tab(page, 'Fly').click();
    await untilState(page, 'GROUND');
  });
});

describe('the log', () => {
  it('is kept once, also when another tab of this page is opened meanwhile, which is told nothing wrong', async () => {
    await begin();
    const first = await open();
    await startVehicle(first, '5×');
    await tab(first, 'Console').click();
    for (let n = 0; n < 12; n++) {
      await type(first, `#PING ${n}`);
      if (n % 2 === 1) {
        const other = await open();
        await other.waitForSelector('.sheet');
        await other.waitForTimeout(150);
        expect(await other.innerText('body')).not.toContain('The page was reloaded');
        await other.close();
      }
      await first.waitForTimeout(170);
    }
    await first.bringToFront();
    await first.waitForTimeout(1500);
    await first.locator('.status').click();
    await button(first, 'Disconnect').click();
    await button(first, 'Close').click();
    const lines = await savedLines(first);
    expect(twice(lines)).toEqual([]);
    expect(pings(lines)).toEqual([...Array(12).keys()].map(String));
    expect(await first.locator('.sessions li').first().innerText()).toContain(`${lines.length} lines`);
    expect(errors).toEqual([]);
  });

  for (const [how, broken] of [
    ['refuses at once', 'throw new DOMException("full", "QuotaExceededError")'],
    ['gives up at the end', 'this.transaction.abort(); return original.apply(this, args)'],
    ['gives up late', 'const request = original.apply(this, args); setTimeout(() => {}, 0); request.onsuccess = () => request.transaction.abort(); return request'],
  ] as const) {
    it(`loses nothing to a write that ${how}; says so, and tries again`, async () => {
      await begin();
      const page = await open();
      await startVehicle(page);
      await tab(page, 'Console').click();
      await type(page, '#PING 0');
      await page.waitForTimeout(1300);
      await page.evaluate(`{
        const original = IDBObjectStore.prototype.put;
        window.mend = () => { IDBObjectStore.prototype.put = original; };
        IDBObjectStore.prototype.put = function (...args) { ${broken}; };
      }`);
      for (let n = 1; n < 6; n++) {
        await type(page, `#PING ${n}`);
        await page.waitForTimeout(500);
      }
      await page.waitForFunction(() => document.body.innerText.includes('The browser refuses to keep the log'));
      expect(pings(await savedLines(page))).toEqual(['0', '1', '2', '3', '4', '5']); // also while it is so
      await page.evaluate('window.mend()');
      await page.waitForFunction(() => !document.body.innerText.includes('The browser refuses to keep the log'), undefined, { timeout: 5000 });
      await type(page, '#PING 6');
      await page.waitForTimeout(300);
      await page.reload(); // the last lines come from the tail
      await button(page, 'Close').click();
      await page.waitForFunction(() => document.body.innerText.includes('The page was reloaded.'));
      await tab(page, 'Console').click();
      const lines = await savedLines(page);
      expect(twice(lines)).toEqual([]);
      expect(pings(lines)).toEqual(['0', '1', '2', '3', '4', '5', '6']);
    });
  }
});
