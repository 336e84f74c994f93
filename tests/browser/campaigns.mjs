// Campaigns for the tests, made by the program with a fake Blender or without any; with names that mean harm.

import { execFileSync, spawnSync } from 'node:child_process';
import fs from 'node:fs';
import os from 'node:os';
import path from 'node:path';

export const checkout = path.resolve(import.meta.dirname ?? path.dirname(new URL(import.meta.url).pathname), '../..');
export const program = path.resolve(process.env.SEEDFRAME_PROGRAM ?? path.join(checkout, 'build/release/seedframe'));
export const scratch = fs.mkdtempSync(path.join(os.tmpdir(), 'seedframe-browser-'));
process.on('exit', () => fs.rmSync(scratch, { recursive: true, force: true }));

export const environment = { ...process.env, SEEDFRAME_CACHE: 'off', SEEDFRAME_BLENDER: path.join(checkout, 'tests/fake_blender/fake_blender.py') };
export const HOSTILE = {
  markup: '<img src=x onerror=document.title=1>',
  script: '</script><script>document.title=1</script>',
  turned: 'גלגל שיניים {{data}}',
};

export function run(words, more = {}) {
  const done = spawnSync(program, words, { cwd: scratch, env: { ...environment, ...more }, encoding: 'utf8' });
  if (done.error) throw done.error;
  return done;
}

function submit(name, config, words = [], more = {}) {
  fs.writeFileSync(path.join(scratch, 'campaign.yaml'), config);
  const folder = path.join(scratch, name);
  const done = run(['submit', 'campaign.yaml', '-o', folder, '--quiet', ...words], more);
  if (!fs.existsSync(path.join(folder, 'campaign.sqlite'))) throw new Error(done.stderr);
  return folder;
}

export const config = (name, more) => `seedframe: 1
name: ${name}
seed: 5
scenes: 4
frames_per_scene: 3
categories: ${JSON.stringify(Object.values(HOSTILE))}
render: {width: 96, height: 72, samples: 1}
variables:
  scene: {reach: {uniform: [0.02, 0.1]}}
objects:
  gears: {asset: gear, category: ${JSON.stringify(HOSTILE.markup)}, count: {integer: [1, 2]}, position: [{uniform: [-0.1, 0.1]}, 0, 0]}
  bolts: {asset: hex_bolt, category: ${JSON.stringify(HOSTILE.script)}, position: [reach, 0.05, {normal: [0, 0.02]}]}
  rings: {asset: bearing, category: ${JSON.stringify(HOSTILE.turned)}, position: [0.05, 0.05, 0], rotation_deg: [0, 0, {choice: {0: 1, 90: 2}}]}
  cubes: {asset: {choice: [cube, cone]}, category: none, position: [-0.05, 0.08, 0], scale: 0.2}
camera: {target: [0, 0, 0], distance_m: {uniform: [0.2, 0.5]}}
constraints:
  seen: {type: visible, objects: [gears], at_least: 0.2}
${more}`;

// Labels only; the folder's name is to be text as well.
export const labelled = () => submit(`labels <b onclick=x> "it's"`, config('labelled', 'labels: geometry\n'));

// Pictures by the fake Blender: frame 2 crashes, frame 4 fails, frame 7 is damaged afterwards, frame 9 comes at the second attempt.
export function pictured() {
  const folder = submit('pictured', config('pictured', `labels: {check: false}
image: {ocio_config: /usr/share/blender/datafiles/colormanagement/config.ocio}
`), [], {
    SEEDFRAME_FAKE: JSON.stringify({ crash_frames: [2], crash_attempts: 9, fail_frames: [4, 9], fail_attempts: 1 }),
  });
  return folder;
}

export function withFailures() {
  const folder = submit('failing', config('failing', `labels: {check: false}
image: {ocio_config: /usr/share/blender/datafiles/colormanagement/config.ocio}
`), ['--max-attempts', '1', '--max-crashes', '1'], { SEEDFRAME_FAKE: JSON.stringify({ crash_frames: [2], fail_frames: [4] }) });
  const mask = path.join(folder, 'frames/000/000007/instances.png');
  const bytes = fs.readFileSync(mask);
  bytes[bytes.length >> 1] ^= 1;
  fs.rmSync(mask);
  fs.writeFileSync(mask, bytes);
  for (const name of fs.readdirSync(path.join(folder, 'logs')).filter((each) => each.startsWith('crash-'))) {
    fs.appendFileSync(path.join(folder, 'logs', name), `\n${HOSTILE.markup}\n${HOSTILE.script}\n`);
  }
  return folder;
}

export const hardlyBegun = () => submit('begun', config('begun', 'labels: geometry\n'), ['--frames', '1']);
export const allFailed = () => submit('failed', config('failed', `labels: {check: false}
image: {ocio_config: /usr/share/blender/datafiles/colormanagement/config.ocio}
`), ['--max-attempts', '1'], { SEEDFRAME_FAKE: JSON.stringify({ fail_frames: 'all' }) });

export function report(folder, name = 'report.html') {
  const file = path.join(folder, name);
  execFileSync(program, ['report', folder, '-o', file], { cwd: scratch, env: environment, stdio: 'pipe' });
  return file;
}

// What labels.json says of every finished frame.
export function labelsOf(folder, frames = 12) {
  const all = new Map();
  for (let frame = 0; frame < frames; ++frame) {
    const file = path.join(folder, 'frames/000', String(frame).padStart(6, '0'), 'labels.json');
    if (fs.existsSync(file)) all.set(frame, JSON.parse(fs.readFileSync(file, 'utf8')));
  }
  return all;
}
