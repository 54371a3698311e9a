#!/usr/bin/env bash
# SPDX-FileCopyrightText: The Talus authors
# SPDX-License-Identifier: GPL-3.0-or-later
# Tables and pictures of figures: each shows one commit, and misses stand first.
source "$(dirname "${BASH_SOURCE[0]}")/../lib.sh"

# A tree of the pages and the files that their tables are made of.
tree() {
  mkdir -p tree/docs/explanation tree/tools
  cp "$TALUS_SOURCE/README.md" tree
  cp "$TALUS_SOURCE"/docs/explanation/{validation,performance,architecture}.md tree/docs/explanation
  cp -r "$TALUS_SOURCE/docs/benchmarks" tree/docs
  cp "$TALUS_SOURCE/tools/make-tables.py" tree/tools
}
make_tables() { /usr/bin/python3 tree/tools/make-tables.py "$@"; }

# sitting COMMIT CASE ROW...: a validation.json.
sitting() {
  local commit=$1 name=$2 rows
  shift 2
  rows=$(IFS=, && echo "$*")
  echo "{\"commit\": \"$commit\", \"date\": \"2026-11-22\", \"on\": \"cpu\", \"complete\": false, \"coarse\": false,
    \"cases\": [\"$name\"], \"rows\": [$rows]}"
}

# row CASE QUANTITY COMPUTED LOWEST HIGHEST ERROR TOLERANCE PASS: a judged row.
row() {
  echo "{\"case\": \"$1 some grid\", \"quantity\": \"$2\", \"judged\": true, \"computed\": $3, \"lowest\": $4,
    \"highest\": $5, \"error\": $6, \"tolerance\": $7, \"pass\": $8, \"steps\": 20, \"place\": \"a processor\"}"
}

test_pages_show_what_the_files_hold() {
  tree
  expect_exit 0 make_tables
  for page in README.md docs/explanation/{validation,performance,architecture}.md; do
    cmp "tree/$page" "$TALUS_SOURCE/$page" || fail "the tables of $page are not of the files: make facts"
  done
}

test_a_figure_without_a_source_is_named() {
  tree
  printf '%s\n' '# One' 'It takes 12 s.' '## Two' 'It took 3 s (1a2b3c4d).' '## Three' 'Five cells.' \
    >tree/docs/explanation/a.md
  expect_exit 1 make_tables
  expect_words 'docs/explanation/a.md: One (12 s)'
  if grep -qE 'Two|Three' stderr; then fail "what has a source or no figure is named"; fi
}

test_misses_stand_first_with_the_number_beside_what_is_wanted() {
  tree
  sitting 1a2b3c4d5 B1 "$(row B1 way 1.0005 1 1 0.0005 0.01 true)" "$(row B1 height 1.005 1 1 0.005 0.01 true)" \
    "$(row B1 'cost: steps' 500 null 48 9 0 false)" '{"case": "B1", "quantity": "speed", "judged": false}' >one.json
  sitting 1a2b3c4d5 A3 "$(row A3 run-out 7.5 5 7.08 0.06 0 false)" "$(row A3 height 1.7 1.5 2 0 0 true)" >two.json
  sitting 1a2b3c4d5 B8 "$(row B8 members 500 500 null 0 0 true)" \
    "$(row B8 distance null 1 1 null 0.01 false)" >three.json
  expect_exit 0 make_tables --validation one.json two.json three.json
  grep -A4 '^| case | against | missed' tree/README.md | sed 1,2d >rows
  sed -n 1p rows | grep -qF "| **1** of 2 | 0 | distance no result |" || fail "no result: $(<rows)"
  sed -n 2p rows | grep -qF "| **1** of 2 | 0 | run-out 7.5 (5 to 7.08) |" || fail "band: $(<rows)"
  sed -n 3p rows | grep -qF "| 0 of 2 | 1 | height 1.005 (1, 1 %) |" || fail "no miss: $(<rows)"
  grep -qF 'Commit 1a2b3c4, 2026-11-22, on a processor' tree/README.md || fail "README names no commit"
}

test_rows_of_two_commits_or_of_one_case_twice_are_refused() {
  tree
  sitting 1a2b3c4d5 B1 "$(row B1 way 1 1 1 0 0.01 true)" >one.json
  sitting 9f8e7d6c5 B2 "$(row B2 way 1 1 1 0 0.01 true)" >two.json
  sitting 1a2b3c4d5 X9 "$(row X9 way 1 1 1 0 0.01 true)" >three.json
  expect_exit 1 make_tables --validation one.json two.json
  expect_words 'different commits (1a2b3c4d5, 9f8e7d6c5)'
  expect_exit 1 make_tables --validation one.json one.json
  expect_words 'B1 in more than one file'
  expect_exit 1 make_tables --validation nowhere.json
  expect_words 'nowhere.json was not found' 'make validate'
  cmp tree/docs/benchmarks/validation.csv "$TALUS_SOURCE/docs/benchmarks/validation.csv" || fail "it wrote two states"
  expect_exit 1 make_tables --validation three.json
  expect_words 'rows of X9'
}

test_days_and_commits_are_those_of_the_rows() {
  tree
  local rows=tree/docs/benchmarks/speed-against-error.csv
  sed -i '2,$s/,[0-9a-f]\{8,9\},2026-[-0-9]*,/,0123abcde,2031-05-06,/' "$rows"
  expect_exit 0 make_tables
  tr '\n' ' ' <tree/README.md | grep -qF 'commit 0123abc, 2031-05-06, by' || fail "the day of the rows is not shown"
  sed -i 's/,2026-[-0-9]*$/,2031-07-08/' tree/docs/benchmarks/kernels.csv
  expect_exit 0 make_tables
  grep -qF '2031-07-08' tree/docs/explanation/performance.md || fail "the day of the kernels' rows is not shown"
}

test_pictures_lose_colours_where_nobody_sees_it() {
  /usr/bin/python3 -c 'import PIL' 2>/dev/null || need_tool python3-pil
  cat >look.py <<'PYTHON'
import importlib.util, pathlib, random, sys
from PIL import Image, ImageChops
spec = importlib.util.spec_from_file_location("pictures", sys.argv[1])
pictures = importlib.util.module_from_spec(spec)
spec.loader.exec_module(pictures)
random.seed(1)
def through(image):
    image.save("it.png")
    pictures.shrink(pathlib.Path("it.png"))
    with Image.open("it.png") as shrunk:
        worst = max(high for _, high in ImageChops.difference(image.convert("RGB"), shrunk.convert("RGB")).getextrema())
        return shrunk.mode, worst
shaded = Image.new("RGB", (500, 400))
shaded.putdata([(128 + x // 5, 128 + x // 5, 120 + y // 4) if x > 60 else (200, 30 + 50 * (y // 100), 0)
                for y in range(400) for x in range(500)])
mode, worst = through(shaded)
assert mode == "P" and worst <= 40, f"a shaded map: {mode}, {worst}"
noise = Image.new("RGB", (300, 300))
noise.putdata([tuple(random.randrange(256) for _ in range(3)) for _ in range(90000)])
assert through(noise) == ("RGB", 0), "all colours there are became few"
clear = Image.new("RGBA", (50, 50), (10, 20, 30, 99))
assert through(clear)[0] == "RGBA", "what shines through is lost"
assert through(shaded.quantize(64))[1] == 0, "few colours became others"
PYTHON
  expect_exit 0 /usr/bin/python3 look.py "$TALUS_SOURCE/tools/make-pictures.py"
}

test_every_picture_of_the_documents_is_listed_with_what_makes_it() {
  local folder=$TALUS_SOURCE/docs/pictures
  diff <(grep -oE '"[^"]+\.png"' "$folder/pictures.json" | tr -d '"' | sort) <(cd "$folder" && ls -- *.png | sort) ||
    fail "pictures.json names others than there are"
}

test_rows_of_two_commits_are_not_drawn() {
  local table=$TALUS_SOURCE/docs/benchmarks/speed-against-error.csv commit
  commit=$(tail -n 1 "$table" | cut -d, -f3)
  sed "\$s/,$commit,/,0123abcde,/" "$table" >mixed.csv
  expect_exit 1 /usr/bin/python3 "$TALUS_SOURCE/tools/plot-speed-against-error.py" mixed.csv drawn.png
  expect_words 'rows of more than one commit'
  [[ ! -e drawn.png ]] || fail "it was drawn"
}

# A program of tests that reports two cases on a GPU and one beside it, and a GPU's name.
pretend_gpu() {
  cat >tests <<'SCRIPT'
#!/bin/bash
[[ $TALUS_REQUIRE_GPU == 1 ]] || exit 9
suites='"testsuites": []'
[[ $GTEST_SHARD_INDEX == 1 ]] || suites='"testsuites": [{"name": "Steps", "testsuite": [
  {"name": "fall", "result": "COMPLETED", "on": "gpu"}, {"name": "rest", "result": "COMPLETED", "on": "gpu"'$FAILS'},
  {"name": "read", "result": "COMPLETED"}]}]'
echo "{$suites}" >"${GTEST_OUTPUT#json:}"
SCRIPT
  printf '%s\n' '#!/bin/bash' 'echo "A GPU"' >nvidia-smi
  chmod +x tests nvidia-smi
}

test_a_file_tells_which_cases_have_passed_on_a_gpu() {
  pretend_gpu
  local record=("$TALUS_SOURCE/tools/record-gpu-tests.py" ./tests --commit 0123abcd --jobs 2 --out gpu.csv)
  PATH=$PWD:$PATH expect_exit 0 /usr/bin/python3 "${record[@]}"
  grep -qF '3 cases, 2 of them on one A GPU, 0 failed' stdout || fail "it says something else"
  grep -qE '^Steps.rest,passed,A GPU,0123abcd,2[0-9-]+$' gpu.csv || fail "$(<gpu.csv)"
  if grep -q read gpu.csv; then fail "a case that used no GPU is in the file"; fi
  FAILS=', "failures": [{"failure": "3 is not 4"}]' PATH=$PWD:$PATH expect_exit 1 /usr/bin/python3 "${record[@]}"
  grep -qF 'Steps.rest: 3 is not 4' stdout || fail "the failure is not named"
  grep -q '^Steps.rest,failed,' gpu.csv || fail "$(<gpu.csv)"
}

# What no check of every change can do: kernels run on a GPU. So a file of results is part of the project.
test_kernels_passed_on_a_gpu_not_more_than_ten_changes_of_them_ago() {
  local results=$TALUS_SOURCE/docs/benchmarks/gpu-tests.csv commit changes git=(git -C "$TALUS_SOURCE")
  if grep -vE '^test,result|,passed,' "$results"; then fail "not every case has passed"; fi
  commit=$(sed -n 2p "$results" | cut -d, -f4)
  "${git[@]}" cat-file -e "$commit" 2>/dev/null || skip "there is no history here that knows $commit"
  mapfile -t kernels < <("${git[@]}" grep -lE 'TALUS_HD|__global__' -- solver)
  changes=$("${git[@]}" rev-list --count "$commit..HEAD" -- "${kernels[@]}")
  [[ ${#kernels[@]} -gt 50 && $changes -le 10 ]] ||
    fail "$changes commits have changed kernels since $commit, whose tests are recorded. On a GPU: make test-gpu"
}

run_test "$@"
