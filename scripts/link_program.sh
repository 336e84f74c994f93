#!/bin/sh
# Makes a built program a command of its user, by a link in a folder of PATH, and says what it did. A command of the
# same name that is another program stays.
#
#   scripts/link_program.sh PROGRAM [FOLDER]    FOLDER: /usr/local/bin for root, else ~/.local/bin
set -eu
program=$(readlink -f "$1")
name=$(basename "$program")
if [ "$(id -u)" = 0 ]; then usual=/usr/local/bin; else usual=$HOME/.local/bin; fi
folder=${2:-$usual}
link=$folder/$name

found=$(command -v "$name" || true)
if [ -n "$found" ] && [ "$(readlink -f "$found")" = "$program" ]; then
  echo "'$name' is $found, which is this one"
elif [ -n "$found" ]; then
  echo "'$name' is another program, $found: this one is $program"
elif [ -e "$link" ]; then
  if [ "$(readlink -f "$link")" = "$program" ]; then
    echo "$link is this one, but $folder is not in PATH: log in again, or add it"
  else
    echo "$link is another program: this one is $program"
  fi
else
  mkdir -p "$folder"
  ln -sf "$program" "$link" # also over a link that leads nowhere
  echo "linked $link to $program"
  case ":$PATH:" in
    *":$folder:"*) ;;
    *) echo "$folder is not in PATH: log in again, or add it" ;;
  esac
fi
