import type { Browser, Page } from 'playwright-core';
import { afterAll, afterEach, beforeAll, describe, expect, it } from 'vitest';
import { button, freePort, openBrowser, openPage, serialBrowser, serveSite, startBoard, startVehicle, tab, untilLaserIsOk, whyNoSerial, type Board, type Site } from './rig';

/** From the end of the telemetry to a page that claims nothing any more. */
const PATIENCE_MS = 1500;

let browser: Browser;
let site: Site;
let page: Page;
let board: Board | null = null;

beforeAll(async () => {
  site = await serveSite();
  browser = await openBrowser();
});
afterAll(async () => {
  await browser?.close();
  site?.close();
});
afterEach(async () => {
  board?.process.kill('SIGCONT');
  await board?.stop();
  board = null;
  await page?.context().close();
});

/** Everything visible that is drawn in a green: what it is. A picture is grey when it, or what it is in, is. */
async function greens(): Promise<string[]> {
  return page.evaluate(() => (window as unknown as { greens(): string[] }).greens());
}

/** Looks ten times a second, and remembers when anything was green last, and for how long this machine has not run the page. */
async function watch(): Promise<void> {
  await page.evaluate(() => {
    const isGreen = (colour: string): boolean => {
      const [r = 0, g = 0, b = 0, a = 1] = (/^color\(srgb/.test(colour) ? (colour.match(/[\d.e-]+/g) ?? []).map((part, i) => (i < 3 ? Number(part) * 255 : Number(part))) : (colour.match(/[\d.]+/g) ?? []).map(Number));
      const most = Math.max(r, g, b);
      const least = Math.min(r, g, b);
      if (a < 0.05 || most === 0 || (most - least) / most < 0.12 || g !== most) return false;
      const hue = 60 * (2 + (b - r) / (most - least));
      return hue > 75 && hue < 170; // the page's own accent, a teal, is at 175
    };
    const greens = (): string[] => {
      const found: string[] = [];
      for (const element of document.querySelectorAll('body *')) {
        const box = element.getBoundingClientRect();
        if (box.width === 0 || box.height === 0) continue;
        const style = getComputedStyle(element);
        if (style.visibility === 'hidden') continue;
        const name = `${element.tagName.toLowerCase()}.${element.getAttribute('class') ?? ''} "${(element.textContent ?? '').slice(0, 30)}"`;
        if (element instanceof HTMLCanvasElement) {
          let at: Element | null = element;
          while (at && !getComputedStyle(at).filter.includes('grayscale(1)')) at = at.parentElement;
          const pixels = at ? [] : element.getContext('2d')!.getImageData(0, 0, element.width, element.height).data;
          for (let i = 0; i < pixels.length; i += 4) {
            if (pixels[i + 3]! > 200 && isGreen(`rgb(${pixels[i]}, ${pixels[i + 1]}, ${pixels[i + 2]})`)) {
              found.push(`${name} in its picture`);
              break;
            }
          }
          continue;
        }
        const own = [...element.childNodes].some((node) => node.nodeType === Node.TEXT_NODE && node.textContent!.trim() !== '');
        const colours = [own ? style.color : '', style.backgroundColor, style.borderTopWidth === '0px' ? '' : style.borderTopColor, style.boxShadow, element instanceof SVGElement ? `${style.fill};${style.stroke}` : ''];
        for (const colour of colours.flatMap((text) => text.match(/(?:rgba?|color)\([^)]*\)/g) ?? [])) if (isGreen(colour)) found.push(`${name} ${colour}`);
      }
      return found;
    };
    const LOOK_MS = 100;
    const seen = { greens, lastGreen: 0, lastGreens: [] as string[], stalled: 0 };
    let before = Date.now();
    Object.assign(window, seen);
    setInterval(() => {
      Object.assign(window, { stalled: Math.max((window as unknown as typeof seen).stalled, Date.now() - before - LOOK_MS) });
      before = Date.now();
      const found = greens();
      if (found.length > 0) Object.assign(window, { lastGreen: Date.now(), lastGreens: found });
    }, LOOK_MS);
  });
}

const text = (): Promise<string> => page.innerText('main');

/** `end` stops the telemetry; `began` is when it did, by the clock of this machine. */
async function goesGrey(end: () => Promise<unknown> | unknown): Promise<void> {
  await page.waitForFunction(() => document.querySelector('.messages')?.textContent?.includes('All is well'), undefined, { timeout: 30_000 });
  await watch();
  await page.waitForTimeout(500);
  expect((await greens()).join('\n')).toContain('All is well'); // the test can see green
  await page.evaluate(() => Object.assign(window, { stalled: 0 }));
  await end();
  const ended = Date.now();
  await page.waitForTimeout(PATIENCE_MS + 1500);
  const { lastGreen, lastGreens, stalled } = await page.evaluate(() => { const { lastGreen: last, lastGreens: found, stalled: stall } = window as unknown as { lastGreen: number; lastGreens: string[]; stalled: number }; return { lastGreen: last, lastGreens: found, stalled: stall }; });
  expect(lastGreen - ended, `still green:\n${lastGreens.join('\n')}`).toBeLessThan(PATIENCE_MS + stalled);
  expect(await text()).not.toContain('All is well');
  for (const sub of await page.locator('.numbers .big-sub').allInnerTexts()) expect(sub).toMatch(/\b[2-9]\d? s ago/);
  const age = async (): Promise<number> => Number(/(\d+) s ago/.exec(await page.locator('.numbers .big-sub').first().innerText())![1]);
  const before = await age();
  await page.waitForTimeout(2100);
  expect(await age()).toBeGreaterThan(before); // it goes on, also when the port is gone
  const drawn = (): Promise<string> => page.evaluate(() => document.querySelector('canvas')!.toDataURL());
  const picture = await drawn();
  await page.waitForTimeout(1000);
  expect(await drawn(), 'the plot stands still, as if its end were now').not.toBe(picture);
  for (const name of ['Parameters', 'Recorder', 'Checks', 'Console', 'Fly']) {
    await tab(page, name).click();
    await page.waitForTimeout(150);
    expect(await greens(), name).toEqual([]);
    if (name === 'Parameters' && (await page.locator('[data-parameter]').count()) > 0) expect(await text()).toMatch(/\d+ s ago/);
    if (name === 'Checks') {
      expect(await text()).not.toContain('Ready to fly');
      for (const live of ['Link', 'Laser', 'Height', 'IMU', 'Upright', 'State', 'Flags', 'Settings']) expect(await page.locator('.checks li.done', { hasText: live }).count(), live).toBe(0);
    }
  }
  await page.getByRole('button', { name: 'Light or dark' }).click();
  expect(await greens(), 'in the dark').toEqual([]);
  await page.getByRole('button', { name: 'Light or dark' }).click();
}

async function readParameters(): Promise<void> {
  await tab(page, 'Parameters').click();
  await page.waitForSelector('[data-parameter]', { timeout: 30_000 });
  await tab(page, 'Checks').click();
  await tab(page, 'Fly').click();
}

describe('what the page has not heard for a second and a half is not shown as so: the simulated vehicle', () => {
  async function vehicle(): Promise<void> {
    page = await openPage(browser, site.url);
    await startVehicle(page, '5×');
    await untilLaserIsOk(page);
    await readParameters();
    await button(page, '1×').click();
  }
  it('whose radio is cut', async () => {
    await vehicle();
    await goesGrey(() => button(page, 'Cut radio').click());
    await button(page, 'Mend radio').click();
    await page.waitForFunction(() => document.querySelector('.messages')?.textContent?.includes('All is well'));
  });
  it('that flies slowly is no silent one', async () => {
    await vehicle();
    await button(page, '0.25×').click();
    await page.waitForTimeout(1500);
    await watch();
    const states = await page.evaluate(async () => {
      const seen: string[] = [];
      for (let i = 0; i < 40; i++) {
        seen.push(document.querySelector('.messages')?.textContent ?? '');
        await new Promise((done) => setTimeout(done, 100));
      }
      return seen;
    });
    expect(states.filter((state) => !state.includes('All is well'))).toEqual([]);
  });
  for (const [how, what] of [['stops for good', 'return 0'], ['breaks with an error', 'throw new Error("unreachable")']] as const) {
    it(`whose program ${how}`, async () => {
      page = await browser.newPage();
      await page.addInitScript(`
        const original = WebAssembly.instantiate;
        WebAssembly.instantiate = async (...args) => {
          const instance = await original(...args);
          return { exports: { ...instance.exports, vehicle_step(ms) { if (window.halt) { ${what}; } return instance.exports.vehicle_step(ms); } } };
        };`);
      await page.goto(site.url);
      await startVehicle(page, '5×');
      await untilLaserIsOk(page);
      await readParameters();
      await goesGrey(() => page.evaluate(() => Object.assign(window, { halt: true })));
      expect(await page.innerText('body')).toContain('The simulated firmware has stopped for good.');
    });
  }
  it('that was disconnected by the operator', async () => {
    await vehicle();
    await goesGrey(async () => {
      await page.locator('.status').click();
      await button(page, 'Disconnect').click();
      await button(page, 'Close').click();
    });
  });
});

describe('by WebSocket', () => {
  async function connected(): Promise<void> {
    board = await startBoard(`${await freePort()}`);
    page = await openPage(browser, site.url);
    await page.getByLabel('Address').fill(board.address);
    await button(page, 'Connect').click();
    await untilLaserIsOk(page);
    await readParameters();
  }
  it('a program that hangs', async () => {
    await connected();
    await goesGrey(() => board!.process.kill('SIGSTOP'));
  });
  it('a program that ended', async () => {
    await connected();
    await goesGrey(() => board!.stop());
    expect(await page.locator('.status').innerText()).toContain('Link lost');
  });
});

const why = whyNoSerial();
describe.skipIf(why !== null)(`by Web Serial${why ? ` (not here: ${why})` : ''}`, () => {
  async function connected(): Promise<Browser> {
    board = await startBoard('pty');
    const own = await serialBrowser(board.address, site.url);
    page = await openPage(own, site.url);
    await button(page, 'Open the port used last').click();
    await untilLaserIsOk(page);
    await readParameters();
    return own;
  }
  it('a vehicle out of reach: the port is open and nothing comes', async () => {
    const own = await connected();
    await goesGrey(() => board!.process.kill('SIGSTOP'));
    await own.close();
  });
  it('a port that is gone', async () => {
    const own = await connected();
    await goesGrey(() => board!.stop());
    expect(await page.locator('.status').innerText()).toContain('Link lost');
    await own.close();
  });
});

describe('a calibration', () => {
  it('is over on the page when nothing is heard any more; the vehicle is told to stop, until it answers', async () => {
    board = await startBoard(`${await freePort()}`);
    page = await openPage(browser, site.url);
    await page.getByLabel('Address').fill(board.address);
    await button(page, 'Connect').click();
    await untilLaserIsOk(page);
    await tab(page, 'Checks').click();
    await page.getByLabel('The vehicle is tied down').check();
    await button(page, 'Begin').click();
    await page.waitForFunction(() => parseFloat(document.querySelector('.alarm .big-value')?.textContent ?? '0') > 0.1, undefined, { timeout: 20_000 });
    board.process.kill('SIGSTOP');
    await page.waitForSelector('.alarm', { state: 'detached', timeout: PATIENCE_MS + 500 });
    expect(await text()).toContain('Ended (nothing is heard any more: the vehicle ends it by itself within 3 s)');
    board.process.kill('SIGCONT');
    await page.waitForSelector('.stop.answered');
  });
});
