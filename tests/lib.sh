# SPDX-FileCopyrightText: The Talus authors
# SPDX-License-Identifier: GPL-3.0-or-later
# What the shell tests share. A test script sources this, defines test_NAME() functions and ends with: run_test "$@"
# CTest sets TALUS_SOURCE (the project), TALUS_BUILD (its build) and TALUS_SCRATCH (an empty folder of this test).
# GDAL must not leave statistics (.aux.xml) beside files that another test looks at meanwhile.
export GDAL_PAM_ENABLED=NO
set -euo pipefail
export LC_ALL=C
unset MAKEFLAGS MAKELEVEL MFLAGS   # 'make test' is no part of what a test's own make sees

: "${TALUS_SOURCE:?run through ctest}" "${TALUS_BUILD:?run through ctest}" "${TALUS_SCRATCH:?run through ctest}"
bin=$TALUS_BUILD/bin
is_made=${TALUS_SCRATCH%.*}.is_made   # where test_is_made of the same script has left its files

fail() {
  echo "FAILED: $*" >&2
  for stream in stdout stderr; do
    if [[ -s $TALUS_SCRATCH/$stream ]]; then sed "s/^/  $stream: /" "$TALUS_SCRATCH/$stream" | tail -n 40 >&2; fi
  done
  exit 1
}

# Skips aloud; fails where what is missing was promised (make test promises the tools that make setup installs).
skip() {
  echo "SKIPPED: $*" >&2
  exit 77
}
need_tool() {
  command -v "$1" >/dev/null && return
  [[ -z ${TALUS_REQUIRE_TOOLS:-} ]] || fail "$1 is missing, but TALUS_REQUIRE_TOOLS is set (make setup installs it)"
  skip "$1 is not installed (make setup installs it)"
}

# need_browser: pages are opened by Debian's Chromium and its driver; Ubuntu's packages of these names only lead to the
# snap store.
need_browser() {
  local id
  id=$(. /etc/os-release && echo "$ID")
  [[ $id == debian ]] || skip "the page is not opened in a browser: only Debian packages one that tests can drive"
  need_tool chromium
  need_tool chromedriver
  /usr/bin/python3 -c 'import selenium, osgeo' 2>/dev/null || need_tool python3-selenium
}

# expect_exit CODE COMMAND...: runs it, keeps both streams, and fails unless it ends with CODE.
expect_exit() {
  local expected=$1 code=0
  shift
  "$@" >"$TALUS_SCRATCH/stdout" 2>"$TALUS_SCRATCH/stderr" </dev/null || code=$?
  [[ $code -eq $expected ]] || fail "exit code $code instead of $expected: $*"
}

# expect_error PART...: the last command said exactly this on stderr, the parts one behind the other, as a line of its
# own.
expect_error() {
  local line
  line=$(printf '%s' "$@")
  grep -qxF -- "$line" "$TALUS_SCRATCH/stderr" || fail "stderr has no line: $line"
}

# expect_words TEXT...: each of these stands somewhere on stderr.
expect_words() {
  local text
  for text in "$@"; do
    grep -qF -- "$text" "$TALUS_SCRATCH/stderr" || fail "stderr does not say: $text"
  done
}

# expect_stdout_paths: stdout holds nothing but paths of files that exist.
expect_stdout_paths() {
  [[ -s $TALUS_SCRATCH/stdout ]] || fail "no result path on stdout"
  local path
  while IFS= read -r path; do
    [[ -f $path ]] || fail "stdout says '$path', which is no file"
  done <"$TALUS_SCRATCH/stdout"
}

# expect_no_file DIR [EXCEPT...]: DIR is missing or holds no file, not even a hidden one, but those named, what lies in
# folders named, and logs of stages.
expect_no_file() {
  local folder=$1 file name except
  shift
  [[ -d $folder ]] || return 0
  while IFS= read -r -d '' file; do
    name=${file#"$folder"/}
    for except in "$@"; do
      [[ $name != "$except" && $name != "$except"/* ]] || continue 2
    done
    fail "$file was left behind"
  done < <(find "$folder" -type f ! -regex '.*/\(preprocess\|solve\|postprocess\)\(\.[^/]*\)?\.log' -print0)
}

# made: a copy of what test_is_made has left, in the current folder.
made() { cp -a "$is_made/." .; }

run_test() {
  local name=${1:?which test?}
  rm -rf "$TALUS_SCRATCH"
  mkdir -p "$TALUS_SCRATCH"
  cd "$TALUS_SCRATCH"
  "test_$name"
  echo "passed: $name"
}
