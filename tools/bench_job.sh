#!/bin/sh
# bench_job.sh PYTHON [BASE]   the whole job of today's build beside that of an older commit (benchmarks/job.py). BASE is
# a checkout of the older commit; without it one is made in build/bench-job/base. Both zips must want the same Blender.
set -eu
cd "$(dirname "$0")/.."

python=$PWD/$1
base=${2:-build/bench-job/base}
commit=b961f62

if [ ! -d "$base" ]; then
    git worktree add --detach "$base" "$commit"
fi
if ! ls "$base"/dist/*.zip >/dev/null 2>&1; then
    (cd "$base" && "$python" kernel/build.py --host build/kernel-wheels && "$python" tools/build_extension.py)
fi
exec "$python" -m benchmarks.job "$base"
