import { spawn, type ChildProcess } from 'node:child_process';
import { accessSync, chmodSync, constants, existsSync, mkdirSync, mkdtempSync, readFileSync, statSync, writeFileSync } from 'node:fs';
import { createServer, type Server } from 'node:http';
import type { AddressInfo } from 'node:net';
import { tmpdir } from 'node:os';
import { extname, join, resolve } from 'node:path';
import { chromium, firefox, type Browser, type Page } from 'playwright-core';

export const ROOT = resolve(import.meta.dirname, '../../..');
export const PLOMADA = join(ROOT, 'build/plomada');
const PYTHON = join(ROOT, 'build/venv/bin/python');
const BRIDGE = join(ROOT, 'tools/ground/bridge.py');
const SITE = join(ROOT, 'build-ground');
const CHROMIUM = process.env.CHROMIUM ?? '/usr/bin/chromium';
/** The system's own, by WebDriver BiDi; null: none here. */
export const FIREFOX = [process.env.FIREFOX ?? '', '/usr/bin/firefox-esr', '/usr/bin/firefox'].find((path) => path !== '' && existsSync(path)) ?? null;
/** Pictures for docs/ground.md: `PICTURES=1 make test-ground` renews them. */
const PICTURES = process.env.PICTURES ? join(ROOT, 'docs/images') : join(ROOT, 'build-ground/pictures');

export interface Site {
  url: string;
  close(): void;
}

export function serveSite(): Promise<Site> {
  const types: Record<string, string> = { '.html': 'text/html', '.js': 'text/javascript' };
  const server: Server = createServer((request, response) => {
    const path = join(SITE, request.url === '/' ? 'index.html' : request.url!.split('?')[0]!);
    try {
      const content = readFileSync(path);
      response.writeHead(200, { 'content-type': types[extname(path)] ?? 'application/octet-stream' }).end(content);
    } catch {
      response.writeHead(404).end();
    }
  });
  return new Promise((done) => server.listen(0, '127.0.0.1', () => done({ url: `http://localhost:${(server.address() as AddressInfo).port}`, close: () => server.close() })));
}

export async function openBrowser(executable = CHROMIUM, ...more: string[]): Promise<Browser> {
  return chromium.launch({ executablePath: executable, args: ['--no-sandbox', '--disable-gpu', '--js-flags=--expose-gc', ...more] });
}

export async function openFirefox(): Promise<Browser> {
  return firefox.launch({ channel: 'moz-firefox', executablePath: FIREFOX! });
}

export async function openPage(browser: Browser, url: string, options: { width?: number; height?: number; locale?: string } = {}): Promise<Page> {
  const context = await browser.newContext({ viewport: { width: options.width ?? 1280, height: options.height ?? 800 }, locale: options.locale ?? 'en-GB' });
  const page = await context.newPage();
  page.on('pageerror', (error) => { throw error; });
  await page.goto(url);
  return page;
}

export const button = (page: Page, name: string) => page.getByRole('button', { name, exact: true });
export const tab = (page: Page, name: string) => page.locator('nav').getByRole('button', { name, exact: true });
export const big = (page: Page, n: number) => page.locator('.big').nth(n).locator('.big-value');

export async function startVehicle(page: Page, speed?: string): Promise<void> {
  await button(page, 'Start the simulated vehicle').click();
  if (speed) await button(page, speed).click();
}

/** Every group of parameters, also those that the page has closed. */
export async function openGroups(page: Page): Promise<void> {
  await page.waitForSelector('.group', { timeout: 30_000 });
  for (const group of (await page.locator('.group:not([open]) summary').all()).reverse()) await group.click();
  await page.waitForFunction(() => [...document.querySelectorAll('.group')].every((group) => group.querySelector('[data-parameter]')));
}

/** The field of a parameter, wherever its group is. */
export async function parameter(page: Page, name: string, search = 'Search') {
  await page.getByLabel(search, { exact: true }).fill(name, { timeout: 30_000 });
  return page.locator(`[data-parameter="${name}"]`).locator('input, select');
}

export async function untilHeight(page: Page, metres: number, within: number, timeout = 30_000): Promise<void> {
  await page.waitForFunction(([want, by]) => Math.abs(parseFloat(document.querySelector('.big-value')!.textContent!.replace(',', '.')) - want!) <= by!, [metres, within], { timeout });
}

export async function untilState(page: Page, state: string, timeout = 30_000): Promise<void> {
  await page.waitForFunction((want) => document.querySelectorAll('.big-value')[2]?.textContent === want, state, { timeout });
}

export async function untilLaserIsOk(page: Page): Promise<void> {
  await page.waitForFunction(() => document.querySelectorAll('.big-value')[3]?.textContent === 'OK', undefined, { timeout: 40_000 });
}

/** Of the page, or of a part of it alone. */
export async function picture(page: Page, name: string, part?: string): Promise<void> {
  const path = join(PICTURES, `ground-${name}.png`);
  mkdirSync(PICTURES, { recursive: true });
  if (part) await page.locator(part).evaluate((element) => element.scrollIntoView({ block: 'center' })); // not under the page's head
  await (part ? page.locator(part).screenshot({ path }) : page.screenshot({ path }));
}

/** A port that nobody listens on. */
export function freePort(): Promise<number> {
  const server = createServer();
  return new Promise((done) => server.listen(0, '127.0.0.1', () => {
    const { port } = server.address() as AddressInfo;
    server.close(() => done(port));
  }));
}

export interface Board {
  process: ChildProcess;
  address: string; // of its first line
  stop(): Promise<void>;
}

/** `plomada fly` in real time, the radio's ground end at `xbee`. */
export function startBoard(port: string): Promise<Board> {
  const flight = [PLOMADA, 'fly', 'hover-60s', '--realtime'];
  const [program, ...words] = port === 'pty' ? [...flight, '--xbee', 'pty'] : [PYTHON, '-B', BRIDGE, port, ...flight];
  const child = spawn(program!, words, { stdio: ['ignore', 'pipe', 'pipe'] });
  const over = new Promise<void>((done) => child.on('exit', () => done()));
  return new Promise((done, failed) => {
    let text = '';
    child.stderr.on('data', (octets: Buffer) => failed(new Error(octets.toString())));
    child.stdout.on('data', (octets: Buffer) => {
      text += octets.toString();
      const address = /^xbee: (\S+)\n/.exec(text)?.[1];
      if (address) done({ process: child, address, stop: async () => { child.kill('SIGTERM'); await over; } });
    });
  });
}

/** Why a pseudo-terminal cannot stand for this machine's serial port in a browser of its own; null: it can. */
/** Whether a group of tests is skipped, and why; tests/run.py says when nothing may be. */
export function leftOut(why: string | null): boolean {
  if (why !== null && process.env.NOTHING_SKIPPED === '1') throw new Error(`nothing may be skipped in this run: ${why}`);
  return why !== null;
}

export function whyNoSerial(): string | null {
  if (process.getuid?.() !== 0) return 'not root';
  try {
    statSync('/sys/class/tty/ttyS0');
    accessSync('/dev/ttyS0', constants.R_OK);
  } catch {
    return 'no /dev/ttyS0';
  }
  return null;
}

/** A Chromium in a mount namespace of its own: /dev/ttyS0 is the pseudo-terminal, and a policy lets the page open it. */
export function serialBrowser(pty: string, url: string): Promise<Browser> {
  const directory = mkdtempSync(join(tmpdir(), 'plomada-serial-'));
  mkdirSync(join(directory, 'policies/managed'), { recursive: true });
  writeFileSync(join(directory, 'policies/managed/plomada.json'), JSON.stringify({ SerialAllowAllPortsForUrls: [url] }));
  const script = join(directory, 'chromium');
  writeFileSync(script, `#!/bin/sh
mkdir -p /etc/chromium/policies
exec unshare -m sh -c 'mount --bind ${directory}/policies /etc/chromium/policies && mount --bind ${pty} /dev/ttyS0 && exec ${CHROMIUM} "$@"' sh "$@"
`);
  chmodSync(script, 0o755);
  return openBrowser(script);
}
