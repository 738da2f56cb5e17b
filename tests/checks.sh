# Sourced by run.sh and nightly.sh, from the project's folder.

# A locale with decimal commas, for the tests of numbers in files.
make_locale() {
  export LOCPATH=$PWD/build/locales
  mkdir -p "$LOCPATH"
  [ -d "$LOCPATH/de_DE.UTF-8" ] || localedef -i de_DE -f UTF-8 "$LOCPATH/de_DE.UTF-8"
}

# run_ctest ARGUMENTS: ctest on all processors; where CI is set, a test that is skipped has failed.
run_ctest() {
  local result=0 skipped
  ctest -j "$(nproc)" "$@" 2>&1 | tee build/ctest.log || result=$?
  skipped=$(grep -E '\*\*\*(Skipped|Not Run)' build/ctest.log || true)
  if [ -n "${CI:-}" ] && [ -n "$skipped" ]; then
    printf '\nskipped, which counts as failed here:\n%s\n' "$skipped" >&2
    return 1
  fi
  return "$result"
}
