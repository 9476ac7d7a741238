# 4 is the status of a computation that failed, 1 that of any other statement, also through source and -k
cat >no_start.ct <<'END'
scene planar
body m mass=1
revolute h ground m
simulate 1
END
cat >no_step.ct <<'END'
capacitor C1 a 0 1
isource I1 a 0 -C1.v^2
init C1.v = 1
simulate 2
END
cat >wrong.ct <<'END'
bodi a mass=1
END
echo 'source "no_start.ct"' >outer.ct
cat no_start.ct wrong.ct >both.ct
for run in no_start.ct no_step.ct wrong.ct outer.ct "-k both.ct" "-k no_start.ct no_step.ct" \
    "-k -e expect(1==2) no_step.ct"; do
    # shellcheck disable=SC2086
    cotree -q $run >/dev/null 2>errors
    echo "$run: $?"
done
