#!/usr/bin/env bash
# SPDX-FileCopyrightText: The Talus authors
# SPDX-License-Identifier: GPL-3.0-or-later
# What tools/check-install.sh runs inside the fresh root: the packages that lie in /tmp are installed, used and removed.
set -euo pipefail
export LC_ALL=C.UTF-8 DEBIAN_FRONTEND=noninteractive
cd /tmp

fail() { echo "FAILED: $*" >&2; exit 1; }

# Every file of the system; what apt, dpkg and others keep in caches and logs does not count, nor does the folder to
# which Ubuntu's libraries divert /lib while they are installed.
files() {
  find / -xdev \( -path /proc -o -path /sys -o -path /dev -o -path /run -o -path /tmp -o -path /var/log \
    -o -path /var/cache -o -path /var/lib/dpkg -o -path /var/lib/apt -o -path '/*.usr-is-merged' \) -prune \
    -o -print | sort
}

files >before.txt
names=$(for package in ./*.deb; do dpkg-deb -f "$package" Package; done)
plan=$(apt-get --assume-no --no-install-recommends install ./*.deb 2>/dev/null || true)
sed -nE 's/.* ([0-9]+) newly installed.*/packages: \1/p; s/^Need to get (.*) of archives.*/fetched: \1/p
  s/^After this operation, (.*) of .*/on disk: \1/p' <<<"$plan"

began=$SECONDS
apt-get install --yes --no-install-recommends ./*.deb >/tmp/install.log 2>&1 ||
  { tail -n 20 /tmp/install.log >&2; fail "apt-get install"; }
echo "installed in $((SECONDS - began)) s"

# As somebody who owns nothing but a folder.
began=$SECONDS
mkdir -m 777 results
example=/usr/share/talus/pipelines/synthetic-valley/recipe.toml
as_user() { setpriv --reuid=65534 --regid=65534 --clear-groups env -i PATH=/usr/bin:/bin "$@"; }
if command -v talus >/dev/null; then
  as_user talus run "$example" --out results/valley >/dev/null 2>run.log || { tail run.log >&2; fail "talus run"; }
else
  for stage in preprocess solve postprocess; do
    as_user "talus-$stage" "$example" --out results/valley >/dev/null 2>run.log ||
      { tail run.log >&2; fail "talus-$stage"; }
  done
fi
[[ -s results/valley/report.html && -s results/valley/map.png ]] || fail "no report: $(ls results/valley)"
echo "the example ran to its report in $((SECONDS - began)) s ($(nproc) processors)"
grep -E '^  (released|H/L|deposit CSI|largest peak speed) {2,}' results/valley/score.txt
for file in /usr/share/man/man1/talus-solve.1.gz /usr/share/bash-completion/completions/talus-solve \
  /usr/share/talus/styles/thick/deposit_thickness.qml; do
  [[ -s $file ]] || fail "$file was not installed"   # some images leave out /usr/share/man: this one does not
done

apt-get purge --yes $names >/tmp/purge.log 2>&1 || { tail /tmp/purge.log >&2; fail "apt-get purge"; }
apt-get autoremove --purge --yes >>/tmp/purge.log 2>&1
files >after.txt
diff before.txt after.txt >left.txt || fail "left behind, or gone:"$'\n'"$(head -n 40 left.txt)"
echo "removed without trace"
