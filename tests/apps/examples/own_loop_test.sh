#!/usr/bin/env bash
# The example own_loop ends well and says how. own_loop_test.sh PROGRAM
set -euo pipefail
said=$("$1")
echo "$said"
grep -qE '^view 4: [0-9]+ voxels unknown' <<<"$said"
grep -qx 'ended by max_views' <<<"$said"
