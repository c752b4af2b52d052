#!/usr/bin/env bash
# launcher_test.sh LAUNCHER CASE: one case of the launcher, in a folder of its own whose name is no plain word.
set -euo pipefail

launcher=$1
box=$(mktemp -d "${TMPDIR:-/tmp}/pliant läuncher XXXXXX")
chmod 755 "$box"
trap 'chmod -R u+w "$box"; rm -rf "$box"' EXIT
unset PLIANT_BUILD
export PATH=$box/bin:$PATH CALLS=$box/calls
touch "$CALLS"
chmod 666 "$CALLS"

fail() {
  printf 'line %s: %s\n' "${BASH_LINENO[1]}" "$*" >&2
  exit 1
}
expect() { [ "$1" = "$2" ] || fail "got '$1', expected '$2'"; }
expect_in() { [[ $2 == *"$1"* ]] || fail "'$1' is not in '$2'"; }

# Configures as CMake does: a cache made elsewhere is refused, and a failure leaves a cache. Builds where it was
# configured: a program that tells which checkout it is of.
stub_tools() {
  mkdir "$box/bin"
  cat >"$box/bin/cmake" <<'STUB'
#!/usr/bin/env bash
set -eu
echo "cmake $*" >>"$CALLS"
if [ "$1" = --preset ]; then
  [ "$2 $3" = "release -B" ]
  cache=$4/CMakeCache.txt
  text=$(printf 'CMAKE_HOME_DIRECTORY:INTERNAL=%s\nCMAKE_CACHEFILE_DIR:INTERNAL=%s' "$PWD" "$4")
  [ ! -f "$cache" ] || [ "$(cat "$cache")" = "$text" ] || { echo "made elsewhere"; exit 1; }
  echo "$text" >"$cache"
  [ -z "${FAILING_CONFIGURE:-}" ] || { echo "a package is missing"; exit 1; }
  printf '%s\n' "$PWD" "$4" >"$4/build.ninja"
  rm -rf "$4/web"
  [ -z "${WITHOUT_NPM:-}" ] || { mkdir "$4/web"; echo "no npm" >"$4/web/missing"; }
else
  [ "$1" = --build ]
  { read -r home; read -r folder; } <"$2/build.ninja"
  mkdir -p "$folder/bin"
  printf '#!/bin/sh\necho "%s: $*"\n' "$home" >"$folder/bin/pliant"
  chmod +x "$folder/bin/pliant"
fi
STUB
  # Everything is installed.
  cat >"$box/bin/dpkg-query" <<'STUB'
#!/usr/bin/env bash
for package in "${@:3}"; do printf '%s|installed ' "$package"; done
STUB
  chmod +x "$box"/bin/*
}

# make_checkout NAME; its path is then in $checkout.
make_checkout() {
  checkout=$box/$1
  mkdir -p "$checkout/framework"
  cp "$launcher" "$checkout/pliant"
  echo code >"$checkout/framework/code.cpp"
}

# Runs as somebody who may not write where it is forbidden; root may.
plain_user() {
  if [ "$(id -u)" = 0 ]; then
    setpriv --reuid=65534 --regid=65534 --clear-groups "$@"
  else
    "$@"
  fi
}

# run COMMAND...: its exit code, output and errors are then in $code, $out and $err.
run() {
  code=0
  out=$("$@" 2>"$box/err") || code=$?
  err=$(cat "$box/err")
}

builds_then_runs() {
  make_checkout original
  run "$checkout/pliant" run "a b.yaml"
  expect "$code $out" "0 $checkout: run a b.yaml"
  expect_in "the first time" "$err"
  run "$checkout/pliant" run again
  expect "$code $out" "0 $checkout: run again"
  expect "$err" ""
  expect "$(grep -c -- --preset "$CALLS")" 1
  expect "$(grep -c -- --build "$CALLS")" 2
}

sources_are_joined_by_the_first_configuration_alone() {
  make_checkout original
  run "$checkout/pliant" run
  expect_in "-DCMAKE_UNITY_BUILD=ON" "$(grep -- --preset "$CALLS")"
  : >"$CALLS"
  run "$checkout/pliant" bench
  expect "$(grep -- --preset "$CALLS")" "cmake --preset release -B $checkout/build/release -DPLIANT_BENCHMARKS=ON"
}

a_copy_builds_itself() {
  make_checkout original
  "$checkout/pliant" >/dev/null 2>&1
  cp -a "$checkout" "$box/copy"
  : >"$CALLS"
  run "$box/copy/pliant" run
  expect "$code $out" "0 $box/copy: run"
  expect "$(grep -cF "$checkout" "$CALLS")" 0
  run "$checkout/pliant" run
  expect "$out" "$checkout: run"
}

a_moved_checkout_builds_itself() {
  make_checkout original
  "$checkout/pliant" >/dev/null 2>&1
  mv "$checkout" "$box/moved"
  run "$box/moved/pliant" run
  expect "$code $out" "0 $box/moved: run"
  ln -s "$box/moved" "$box/link"
  : >"$CALLS"
  run "$box/link/pliant" run
  expect "$out" "$box/moved: run"
  expect "$(grep -c -- --preset "$CALLS")" 0
}

a_failed_configuration_is_tried_again() {
  make_checkout original
  "$checkout/pliant" >/dev/null 2>&1
  cp -a "$checkout" "$box/copy"
  run env FAILING_CONFIGURE=1 "$box/copy/pliant" run
  expect "$code $out" "1 "
  expect_in "a package is missing" "$err"
  run "$box/copy/pliant" run
  expect "$code $out" "0 $box/copy: run"
}

npm_is_asked_for_again_after_an_hour() {
  make_checkout original
  run env WITHOUT_NPM=1 "$checkout/pliant" run
  expect "$code $out" "0 $checkout: run"
  expect_in "will be pictures: no npm" "$err"
  run "$checkout/pliant" run
  expect "$err" ""
  expect "$(grep -c -- --preset "$CALLS")" 1
  touch -d '-2 hours' "$checkout/build/release/web/missing"
  run "$checkout/pliant" run
  expect "$(grep -c -- --preset "$CALLS")" 2
  [ ! -e "$checkout/build/release/web/missing" ] || fail "not tried again"
}

another_folder_can_be_built_in() {
  make_checkout original
  cd "$box"
  run env PLIANT_BUILD="elsewhere/ü" "$checkout/pliant" run
  expect "$code $out" "0 $checkout: run"
  [ -x "$box/elsewhere/ü/bin/pliant" ] || fail "not built there"
  [ ! -e "$checkout/build" ] || fail "something was made in the checkout"
  mv "$box/elsewhere" "$box/there"
  run env PLIANT_BUILD="there/ü" "$checkout/pliant" run
  expect "$code $out" "0 $checkout: run"
  [ ! -e "$box/elsewhere" ] || fail "built where the folder was before"
  make_checkout second
  run env PLIANT_BUILD="there/ü" "$checkout/pliant" run
  expect "$code $out" "0 $checkout: run"
}

what_is_built_runs_without_writing() {
  make_checkout original
  "$checkout/pliant" >/dev/null 2>&1
  chmod -R a-w "$checkout"
  : >"$CALLS"
  local before
  before=$(cd "$checkout" && find . -printf '%p %T@\n' | sort)
  run plain_user "$checkout/pliant" run "a b.yaml"
  expect "$code $out" "0 $checkout: run a b.yaml"
  expect "$err" ""
  expect "$(cat "$CALLS")" ""
  expect "$(cd "$checkout" && find . -printf '%p %T@\n' | sort)" "$before"
}

what_is_not_built_says_what_to_do() {
  make_checkout original
  refused() {
    chmod -R a-w "$checkout"
    run plain_user "$checkout/pliant" "$@"
    expect "$code $out" "1 "
    expect_in "no permission to write $checkout/build/release" "$err"
    expect_in "PLIANT_BUILD=~/pliant-build $checkout/pliant $*" "$err"
    chmod -R u+w "$checkout"
  }
  refused run
  "$checkout/pliant" >/dev/null 2>&1
  refused test
  refused bench
  touch -d '+1 minute' "$checkout/framework/code.cpp"
  refused run
  mkdir "$box/mine"
  chmod 777 "$box/mine"
  run plain_user env PLIANT_BUILD="$box/mine/build" "$checkout/pliant" run
  expect "$code $out" "0 $checkout: run"
  mv "$checkout" "$box/moved"
  checkout=$box/moved
  refused run
}

a_file_of_another_user_is_named() {
  make_checkout original
  "$checkout/pliant" >/dev/null 2>&1
  touch -d '+1 minute' "$checkout/framework/code.cpp"
  chmod 777 "$checkout/build/release"/{.,.[!.]*,*}
  chmod 444 "$checkout/build/release/.lock"
  run plain_user "$checkout/pliant" run
  expect "$code" 1
  expect_in "no permission to write $checkout/build/release/.lock;" "$err"
}

stub_tools
"$2"
