#!/bin/sh
# Installs what tests/browser needs: Chromium and Node.js from Debian, and from npm what package-lock.json names, by its
# hashes. Run again, it does only what is missing. As root, or with sudo.
set -eu
cd "$(dirname "$0")"

missing=""
[ -x "${CHROMIUM:-/usr/bin/chromium}" ] || missing="chromium"
command -v node >/dev/null || missing="$missing nodejs"
command -v npm >/dev/null || missing="$missing npm"
if [ -n "$missing" ]; then
  as_root=""
  if [ "$(id -u)" != 0 ]; then
    command -v sudo >/dev/null || { echo "install.sh: run this as root, or install sudo" >&2; exit 4; }
    as_root="sudo"
  fi
  echo "install.sh: installing $missing"
  $as_root apt-get update -qq
  $as_root env DEBIAN_FRONTEND=noninteractive apt-get install -y -qq --no-install-recommends $missing >/dev/null
fi
if ! cmp -s package-lock.json node_modules/.installed-lock.json; then
  npm ci --ignore-scripts --no-audit --no-fund --silent
  cp package-lock.json node_modules/.installed-lock.json
fi
