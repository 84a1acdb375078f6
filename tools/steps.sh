# Sourced by the scripts beside it: the repository's root, and steps that say what they do and how
# long it took. Leaves the shell in the root.

root=$(cd "$(dirname "${BASH_SOURCE[0]}")/.." && pwd)
cd "$root"

# Where rustup puts cargo; a shell opened before its installation does not know.
PATH=$PATH:${CARGO_HOME:-${HOME:-}/.cargo}/bin

# Where cargo puts the binary, and the Python that has the figures' packages.
mirrorbench=${CARGO_TARGET_DIR:-$root/target}/release/mirrorbench
python=$root/.venv/bin/python

if [ -t 2 ] && [ -z "${NO_COLOR:-}" ]; then
    bold=$'\e[1m' red=$'\e[31m' green=$'\e[32m' plain=$'\e[0m'
else
    bold='' red='' green='' plain=''
fi

say() { printf '%s\n' "$*" >&2; }

elapsed() { printf '%dm%02ds' $(($1 / 60)) $(($1 % 60)); }

# step NAME COMMAND...: runs the command in a subshell under `set -e` and says how long it took.
# A failure ends the script with the command's status, unless keep_going=yes: then it only joins
# `failed`. (Callers do not use `set -e` themselves: bash would switch it off inside functions.)
keep_going=no
failed=()
step() {
    local name=$1 start=$SECONDS status
    shift
    say "${bold}== $name${plain}"
    (set -e; "$@")
    status=$?
    if [ "$status" -eq 0 ]; then
        say "${green}ok${plain}  $name ($(elapsed $((SECONDS - start))))"
        return
    fi
    say "${red}failed${plain}  $name: exit $status after $(elapsed $((SECONDS - start)))"
    failed+=("$name")
    [ "$keep_going" = yes ] || exit "$status"
}
