// `seedframe serve` in Chromium: it counts while a campaign renders, pauses, resumes, and says when the scheduler died.

import assert from 'node:assert/strict';
import { spawn } from 'node:child_process';
import fs from 'node:fs';
import path from 'node:path';
import { after, before, test } from 'node:test';
import { config, environment, labelled, program, scratch } from './campaigns.mjs';
import { clean, overflows, picture, seriousFaults, startBrowser, stopBrowser, until, visit } from './visitor.mjs';

const FAKE = { SEEDFRAME_FAKE: JSON.stringify({ delay_s: 0.4 }) };
const folder = path.join(scratch, 'growing');
let server = null;
let address = '';

async function started(folders) {
  const child = spawn(program, ['serve', ...folders], { cwd: scratch, env: { ...environment, ...FAKE } });
  const line = await new Promise((resolve) => { child.stdout.once('data', (bytes) => resolve(String(bytes).split('\n')[0])); });
  return { child, line };
}

before(async () => {
  const text = config('growing', 'labels: {check: false}\nimage: {ocio_config: /usr/share/blender/datafiles/colormanagement/config.ocio}\n').replace('scenes: 4', 'scenes: 300');
  fs.writeFileSync(path.join(scratch, 'growing.yaml'), text);
  const run = spawn(program, ['submit', 'growing.yaml', '-o', folder, '--quiet', '--workers', '1'], { cwd: scratch, env: { ...environment, ...FAKE }, stdio: 'ignore', detached: true });
  run.unref();
  for (let i = 0; i < 200 && !fs.existsSync(path.join(folder, 'frames/000/000000')); ++i) await new Promise((resolve) => { setTimeout(resolve, 50); });
  const { child, line } = await started([folder, labelled()]);
  server = child;
  address = line;
  await startBrowser();
});
after(async () => {
  await stopBrowser();
  server?.kill('SIGTERM');
});

const origin = () => new URL(address).origin;
const told = (page) => page.locator('#live-facts').textContent();
const doneOf = (text) => Number(text.match(/^(\d+) of/)[1]);

async function visitCampaign(options = {}) {
  const visited = await visitFirst(options);
  await visited.page.waitForSelector('#live-facts');
  return visited;
}

async function visitFirst(options) {
  // The address leads to the list, and from there to the campaign.
  const visited = await visit(address, { ...options, allowed: [origin()], wait: false });
  await visited.page.getByRole('link', { name: 'growing' }).click();
  await visited.page.waitForSelector('html[data-ready]');
  return visited;
}

test('only who has the token is let in, and nothing else is there', async () => {
  const ask = (url, options = {}) => fetch(url, { redirect: 'manual', ...options }).then(({ status }) => status);
  assert.equal(await ask(`${origin()}/`), 403);
  assert.equal(await ask(`${origin()}/?token=${'0'.repeat(32)}`), 403);
  assert.equal(await ask(address), 303);
  const headers = { 'X-Seedframe-Token': new URL(address).searchParams.get('token') };
  assert.equal(await ask(`${origin()}/c/0/live`, { headers }), 200);
  assert.equal(await ask(`${origin()}/c/0/campaign.yaml`, { headers }), 404);
  assert.equal(await ask(`${origin()}/c/0/%2e%2e/%2e%2e/etc/passwd`, { headers }), 404);
  assert.equal(await ask(`${origin()}/c/0/pause`, { method: 'POST', headers }), 403);
  assert.equal(await ask(`${origin()}/c/0/pause`, { method: 'POST', headers: { ...headers, Origin: 'http://evil.example', 'X-Seedframe': '1' } }), 403);
});

test('it counts while the campaign renders, pauses and resumes', async () => {
  const { page, faults, close } = await visitCampaign();
  const first = doneOf(await told(page));
  await until(page, (n) => Number(document.getElementById('live-facts').textContent.match(/^(\d+) of/)[1]) > n, first);
  assert.match(await page.locator('#live').textContent(), /At work/);
  await page.getByText(/Workers \(/).click();
  await until(page, () => document.querySelectorAll('#live tbody tr').length > 0);
  await until(page, () => /\d MB/.test(document.querySelector('#live tbody')?.textContent ?? ''));
  await until(page, () => [...document.querySelectorAll('.newest img')].some((image) => image.naturalWidth > 0));
  await until(page, () => /to go/.test(document.getElementById('live-facts').textContent));
  assert.deepEqual(await seriousFaults(page), []);
  await picture(page, 'serve-1280');
  await page.getByRole('button', { name: 'Pause' }).click();
  await page.getByRole('button', { name: 'Resume' }).waitFor({ timeout: 15_000 });
  assert.match(await page.locator('#live').textContent(), /Paused/);
  const paused = doneOf(await told(page));
  await page.getByRole('button', { name: 'Resume' }).click();
  await until(page, (n) => Number(document.getElementById('live-facts').textContent.match(/^(\d+) of/)[1]) > n, paused, 20_000);
  clean(faults);
  await close();
});

test('the death of the scheduler is told, and resume takes the frames up', async () => {
  const { page, faults, close } = await visitCampaign({ width: 390 });
  await page.getByText('At work').waitFor({ timeout: 15_000 });
  const locks = fs.readFileSync('/proc/locks', 'utf8').split('\n');
  const { ino } = fs.statSync(path.join(folder, 'campaign.lock'));
  const holder = locks.map((line) => line.trim().split(/\s+/)).find((words) => words[1] === 'FLOCK' && words[5]?.endsWith(`:${ino}`));
  process.kill(Number(holder[4]), 'SIGKILL');
  await page.getByText('The scheduler died').waitFor({ timeout: 15_000 });
  await picture(page, 'serve-390');
  assert.ok(await overflows(page) <= 0);
  assert.deepEqual(await seriousFaults(page), []);
  await page.getByRole('button', { name: 'Resume' }).click();
  await page.getByText('At work').waitFor({ timeout: 15_000 });
  await page.getByRole('button', { name: 'Pause' }).click();
  await page.getByText('Paused').waitFor({ timeout: 15_000 });
  clean(faults);
  await close();
});

test('without anybody who looks it does nothing', async () => {
  const ticks = () => fs.readFileSync(`/proc/${server.pid}/stat`, 'utf8').split(') ')[1].split(' ').slice(11, 13).reduce((sum, n) => sum + Number(n), 0);
  const before = ticks();
  await new Promise((resolve) => { setTimeout(resolve, 3000); });
  assert.ok(ticks() - before <= 3, 'less than a hundredth of a core');
});
