// How long until a report can be used: milliseconds from opening the file until its first page is there, until the grid
// shows its pictures, and until a filter over a draw has been applied. As JSON.
//
//     node tests/bench/page_start.mjs FILE.html

import path from 'node:path';
import { chromium } from '../browser/node_modules/playwright-core/index.mjs';

const file = path.resolve(process.argv[2]);
const browser = await chromium.launch({ executablePath: process.env.CHROMIUM ?? '/usr/bin/chromium', args: ['--no-sandbox'] });
const page = await browser.newPage({ viewport: { width: 1280, height: 900 } });
page.on('pageerror', (error) => { console.error(error.message); process.exitCode = 1; });

const begin = performance.now();
const since = () => Math.round(performance.now() - begin);
const loading = page.goto(`file://${file}`, { waitUntil: 'commit' });
await page.waitForSelector('html[data-ready]', { timeout: 60_000 });
const ready = since();
await loading;

const shown = performance.now();
await page.evaluate(() => { location.hash = '#frames'; });
await page.waitForSelector('.tile canvas');
while (!await page.evaluate(() => {
  const canvas = document.querySelector('.tile canvas');
  return canvas.getContext('2d').getImageData(0, 0, canvas.width, canvas.height).data.some((value) => value > 60 && value < 255);
})) await page.waitForTimeout(10);
const grid = Math.round(performance.now() - shown);

const filtered = performance.now();
await page.getByLabel('Add a filter of a drawn variable').selectOption({ label: 'camera.distance_m' });
await page.getByLabel('camera.distance_m, most').fill('0.45');
await page.getByLabel('camera.distance_m, most').press('Enter');
while (!/ of /.test(await page.locator('#selection-count').textContent())) await page.waitForTimeout(10);
const filter = Math.round(performance.now() - filtered);
const memory = await page.evaluate(() => performance.memory.usedJSHeapSize);
console.log(JSON.stringify({ ready, grid, filter, memory }));
await browser.close();
