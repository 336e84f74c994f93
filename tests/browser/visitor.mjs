// A browser that notes everything that a page should not do.

import assert from 'node:assert/strict';
import fs from 'node:fs';
import path from 'node:path';
import { createRequire } from 'node:module';
import { chromium } from 'playwright-core';

const axe = fs.readFileSync(createRequire(import.meta.url).resolve('axe-core/axe.min.js'), 'utf8');
let browser = null;

export async function startBrowser() {
  browser = await chromium.launch({ executablePath: process.env.CHROMIUM ?? '/usr/bin/chromium', args: ['--no-sandbox'] });
}
export const stopBrowser = () => browser?.close();

export async function visit(address, { width = 1280, height = 900, scheme = 'light', allowed = [], wait = true } = {}) {
  const context = await browser.newContext({ viewport: { width, height }, colorScheme: scheme, bypassCSP: false });
  const page = await context.newPage();
  const faults = [];
  page.on('console', (message) => faults.push(`console ${message.type()}: ${message.text()}`));
  page.on('pageerror', (error) => faults.push(`error: ${error.message}`));
  page.on('requestfailed', (request) => faults.push(`failed: ${request.url().slice(0, 120)}`));
  page.on('request', (request) => {
    const url = request.url();
    const own = url.startsWith('data:') || url.startsWith('blob:') || url.split('#')[0] === page.url().split('#')[0] || url.split('#')[0] === address.split('#')[0];
    if (!own && !allowed.some((prefix) => url.startsWith(prefix))) faults.push(`request: ${url.slice(0, 120)}`);
  });
  await page.goto(address);
  if (wait) await page.waitForSelector('html[data-ready]', { timeout: 20_000 });
  return { page, faults, close: () => context.close() };
}

export const fileAddress = (file, view = '') => `file://${encodeURI(file).replaceAll('#', '%23').replaceAll('?', '%3F')}${view}`;

export async function open(page, view) {
  await page.evaluate((hash) => { location.hash = hash; }, view);
  await page.waitForSelector(`#content[data-view="${view.split('/')[0].slice(1)}"]`);
}

// Until it holds in the page. (Playwright's waitForFunction evaluates text there, which the page's policy forbids.)
export async function until(page, holds, argument, patience_ms = 15_000) {
  const end = Date.now() + patience_ms;
  while (!await page.evaluate(holds, argument)) {
    assert.ok(Date.now() < end, `in vain: ${holds}`);
    await page.waitForTimeout(50);
  }
}

// Everything that waits to be scrolled to is made.
export async function scrollThrough(page) {
  for (let i = 0; i < 12; ++i) {
    await page.mouse.wheel(0, 800);
    await page.waitForTimeout(40);
  }
  await page.evaluate(() => scrollTo(0, 0));
}

export async function seriousFaults(page) {
  // Put in by the debugger's protocol, which the page's policy does not reach.
  await page.evaluate(axe);
  const found = await page.evaluate(() => globalThis.axe.run(document, { resultTypes: ['violations'] }));
  return found.violations.filter(({ impact }) => impact === 'serious' || impact === 'critical')
    .map(({ id, nodes }) => `${id}: ${nodes.slice(0, 3).map((node) => `${node.target} ${node.failureSummary}`).join(' | ')}`);
}

export const overflows = (page) => page.evaluate(() => document.scrollingElement.scrollWidth - innerWidth);

export async function picture(page, name) {
  const folder = process.env.SEEDFRAME_SCREENSHOTS;
  if (folder) await page.screenshot({ path: path.join(folder, `${name}.png`), fullPage: true });
}

// A canvas as text, to see whether it has changed, and whether anything is on it.
export const drawn = (page, selector) => page.locator(selector).first().evaluate((canvas) => canvas.toDataURL());

export function clean(faults) {
  assert.deepEqual(faults, [], 'the page does nothing that it should not');
}
