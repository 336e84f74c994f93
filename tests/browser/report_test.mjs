// The page of `seedframe report`, opened from disk in Chromium.

import assert from 'node:assert/strict';
import fs from 'node:fs';
import path from 'node:path';
import { after, before, test } from 'node:test';
import { HOSTILE, allFailed, hardlyBegun, labelled, labelsOf, report, run, withFailures } from './campaigns.mjs';
import { clean, drawn, fileAddress, open, overflows, picture, scrollThrough, seriousFaults, startBrowser, stopBrowser, until, visit } from './visitor.mjs';

const folders = {};
const reports = {};
before(async () => {
  folders.labels = labelled();
  folders.failing = withFailures();
  for (const name of Object.keys(folders)) reports[name] = report(folders[name]);
  await startBrowser();
});
after(stopBrowser);

const counted = (page) => page.locator('#selection-count').textContent();
const objectsThat = (labels, passes) => [...labels.values()].filter(({ instances }) => instances.some((each) => each.area_px > 0 && passes(each))).length;

test('the same campaign gives the same bytes', () => {
  const again = report(folders.failing, 'again.html');
  assert.ok(fs.readFileSync(reports.failing).equals(fs.readFileSync(again)));
});

test('overlays switch, by mouse and by key', async () => {
  const { page, faults, close } = await visit(fileAddress(reports.failing, '#frames'));
  const canvas = '.tile[data-frame="0"] canvas';
  await page.waitForSelector(canvas);
  await page.waitForTimeout(300);
  const first = await drawn(page, canvas);
  for (const [button, key] of [['Masks', 'm'], ['Boxes', 'b'], ['Names', 'n']]) {
    const before = await drawn(page, canvas);
    const pressed = await page.getByRole('button', { name: button, exact: true }).getAttribute('aria-pressed');
    await page.getByRole('button', { name: button, exact: true }).click();
    await page.waitForTimeout(150);
    assert.notEqual(await drawn(page, canvas), before, `${button} changes the picture`);
    assert.notEqual(await page.getByRole('button', { name: button, exact: true }).getAttribute('aria-pressed'), pressed);
    await page.locator('body').press(key);
    await page.waitForTimeout(150);
    assert.equal(await drawn(page, canvas), before, `${key} takes it back`);
  }
  await page.locator('body').press('m');
  await page.getByLabel('Colours').selectOption('object');
  await page.waitForTimeout(150);
  assert.notEqual(await drawn(page, canvas), first);
  clean(faults);
  await close();
});

test('filters of objects hold for one and the same object', async () => {
  const { page, faults, close } = await visit(fileAddress(reports.labels, '#frames'));
  const labels = labelsOf(folders.labels);
  assert.match(await counted(page), /^12 frames/);
  await page.getByRole('checkbox', { name: HOSTILE.script }).check();
  const ofClass = objectsThat(labels, (each) => each.category === 2);
  await until(page, (n) => document.getElementById('selection-count').textContent.startsWith(`${n} of 12`), ofClass);
  await page.getByLabel('Visible, most, %').fill('90');
  await page.getByLabel('Visible, most, %').press('Enter');
  const hidden = objectsThat(labels, (each) => each.category === 2 && Math.round(1000 * each.visible_fraction) <= 900);
  assert.ok(hidden > 0 && hidden < ofClass, `${hidden} of ${ofClass} frames: the filter has something to do`);
  await until(page, (n) => document.getElementById('selection-count').textContent.startsWith(`${n} of 12`), hidden);
  assert.equal(await page.locator('.tile').count(), hidden);
  await page.getByRole('button', { name: /visible ≤ 90/ }).click();
  await until(page, (n) => document.getElementById('selection-count').textContent.startsWith(`${n} of 12`), ofClass);
  await page.getByRole('button', { name: 'Remove all filters' }).last().click();
  await until(page, () => document.getElementById('selection-count').textContent === '12 frames');
  clean(faults);
  await close();
});

test('filters of sizes, scenes, states and draws', async () => {
  const { page, faults, close } = await visit(fileAddress(reports.failing, '#frames'));
  const passes = (n) => until(page, (k) => document.getElementById('selection-count').textContent.startsWith(`${k} of 12`), n);
  const fill = async (label, text) => { await page.getByLabel(label, { exact: true }).fill(text); await page.getByLabel(label, { exact: true }).press('Enter'); };
  await fill('Scene, least', '3');
  await passes(3);
  await fill('Scene, least', '');
  const labels = labelsOf(folders.failing);
  labels.delete(7); // damaged
  const side = ({ box }) => Math.sqrt(box[2] * box[3]);
  await fill('Box side, least, px', '25');
  await passes(objectsThat(labels, (each) => side(each) >= 25));
  await fill('Box side, least, px', '');
  for (const [state, n] of [['failed', 1], ['quarantined', 1], ['damaged', 1]]) {
    await page.getByRole('checkbox', { name: new RegExp(`^${state}`) }).check();
    await passes(n);
    await page.getByRole('checkbox', { name: new RegExp(`^${state}`) }).uncheck();
  }
  await page.getByLabel('Add a filter of a drawn variable').selectOption({ label: 'variables.scene.reach' });
  const draws = [0, 1, 3, 5, 6, 8, 9, 10, 11].map((frame) => JSON.parse(run(['explain', folders.failing, String(frame), '--json']).stdout).draws['variables.scene.reach']);
  const middle = [...draws].sort((a, b) => a - b)[4];
  await fill('variables.scene.reach, most', String(middle + 1e-6));
  await passes(draws.filter((value) => value <= middle + 1e-6).length);
  await fill('Frame, least', '900');
  await page.waitForSelector('#nothing-passes:not([hidden])');
  clean(faults);
  await close();
});

test('a frame opens with its objects, draws, attempts and command', async () => {
  const { page, faults, close } = await visit(fileAddress(reports.failing, '#frames'));
  await page.locator('.tile[data-frame="5"]').click();
  await page.waitForSelector('#content[data-view="frame"]');
  const { instances } = labelsOf(folders.failing).get(5);
  assert.equal(await page.getByLabel('Objects of this frame').locator('tbody tr').count(), instances.length);
  await page.waitForSelector('[aria-label="Draws of this frame"]');
  const text = await page.locator('#content').textContent();
  assert.ok(text.includes('camera.distance_m'));
  assert.ok(text.includes('seedframe resume failing --frame 5'));
  const explained = JSON.parse(run(['explain', folders.failing, '5', '--json']).stdout);
  assert.ok(text.includes(explained.frame_id), 'the frame’s id');
  const before = await drawn(page, 'canvas.large');
  await page.locator('.swatch-button').first().click();
  await page.waitForTimeout(150);
  assert.notEqual(await drawn(page, 'canvas.large'), before, 'the object is marked');
  await page.locator('body').press('ArrowRight');
  await until(page, () => document.querySelector('h2').textContent === 'Frame 6');
  await page.locator('body').press('Escape');
  await page.waitForSelector('#content[data-view="frames"]');
  clean(faults);
  await close();
});

test('failed, quarantined and damaged frames say so, with logs as text', async () => {
  const { page, faults, close } = await visit(fileAddress(reports.failing, '#run'));
  await page.getByText('Frame 2', { exact: false }).first().click();
  const log = await page.locator('.failure[open] .log').textContent();
  assert.ok(log.includes(HOSTILE.markup) && log.includes(HOSTILE.script));
  await open(page, '#frame/7');
  await page.getByText('not as they were written').waitFor();
  await open(page, '#frame/4');
  await page.getByText('The last attempt failed').waitFor();
  assert.ok((await page.locator('.message').first().textContent()).includes('fake: will not render'));
  await open(page, '#frame/99');
  await page.getByText('There is no frame 99').waitFor();
  clean(faults);
  await close();
});

test('charts are drawn, and follow the filters', async () => {
  const { page, faults, close } = await visit(fileAddress(reports.labels, '#overview'));
  await scrollThrough(page);
  const canvases = page.locator('.plot canvas');
  assert.ok(await canvases.count() >= 8);
  for (let i = 0; i < await canvases.count(); ++i) {
    const blank = await canvases.nth(i).evaluate((canvas) => canvas.getContext('2d').getImageData(0, 0, canvas.width, canvas.height).data.every((value) => value === 0));
    assert.ok(!blank, await canvases.nth(i).getAttribute('aria-label'));
  }
  assert.ok(!(await page.locator('.card').first().textContent()).includes('selection'));
  await open(page, '#frames');
  await page.getByRole('checkbox', { name: HOSTILE.markup }).check();
  await page.getByLabel('Frame, most', { exact: true }).fill('4');
  await page.getByLabel('Frame, most', { exact: true }).press('Enter');
  await open(page, '#overview');
  assert.match(await page.getByText('Size of boxes').locator('..').textContent(), /\d+ of \d+ objects/);
  await open(page, '#variables');
  await page.getByLabel('Find a variable').fill('distance');
  await until(page, () => /^1 of \d+ variables/.test(document.querySelector('.toolbar .count').textContent));
  assert.ok((await page.locator('#content').textContent()).includes('Constraints'));
  clean(faults);
  await close();
});

test('hostile names are text everywhere', async () => {
  const { page, faults, close } = await visit(fileAddress(reports.labels));
  for (const view of ['#overview', '#frames', '#variables', '#run', '#frame/0']) {
    await open(page, view);
    await scrollThrough(page);
    assert.equal(await page.locator('img[src="x"]').count(), 0);
    assert.notEqual(await page.title(), '1');
    assert.equal(await page.locator('body script:not([type])').count(), 2, 'the page’s own two scripts');
  }
  await open(page, '#frame/0');
  await page.getByText('Made again by').waitFor();
  const text = await page.locator('#content').textContent();
  for (const name of Object.values(HOSTILE)) assert.ok(text.includes(name), name);
  assert.ok(text.includes(`'labels <b onclick=x> "it'\\''s"'`), 'quoted for a shell');
  clean(faults);
  await close();
});

test('the grid goes by the arrow keys', async () => {
  const { page, faults, close } = await visit(fileAddress(reports.labels, '#frames'));
  await page.locator('.tile').first().focus();
  await page.keyboard.press('ArrowRight');
  assert.equal(await page.evaluate(() => document.activeElement.dataset.at), '1');
  await page.keyboard.press('End');
  assert.equal(await page.evaluate(() => document.activeElement.dataset.at), '11');
  await page.keyboard.press('Enter');
  await page.waitForSelector('#content[data-view="frame"]');
  clean(faults);
  await close();
});

for (const [width, scheme] of [[1280, 'light'], [1280, 'dark'], [390, 'light'], [390, 'dark']]) {
  test(`no serious fault of accessibility, nothing wider than the window: ${width} px, ${scheme}`, async () => {
    for (const name of width === 1280 && scheme === 'light' ? Object.keys(reports) : ['failing']) {
      const { page, faults, close } = await visit(fileAddress(reports[name]), { width, scheme });
      for (const view of ['#overview', '#frames', '#variables', '#run', '#frame/0', '#frame/2']) {
        await open(page, view);
        await scrollThrough(page);
        assert.deepEqual(await seriousFaults(page), [], `${name} ${view}`);
        assert.ok(await overflows(page) <= 0, `${name} ${view} fits into ${width} px`);
        await picture(page, `${name}-${view.slice(1).replace('/', '-')}-${width}-${scheme}`);
      }
      clean(faults);
      await close();
    }
  });
}

test('campaigns that have hardly begun, or failed whole, have something to say', async () => {
  for (const [folder, words] of [[hardlyBegun(), '11 frames not made yet'], [allFailed(), '12 frames failed']]) {
    const { page, faults, close } = await visit(fileAddress(report(folder)));
    await page.getByText(words).first().waitFor();
    for (const view of ['#frames', '#variables', '#run', '#frame/3']) {
      await open(page, view);
      assert.deepEqual(await seriousFaults(page), [], `${path.basename(folder)} ${view}`);
    }
    await picture(page, `${path.basename(folder)}-390`);
    clean(faults);
    await close();
  }
});
