# benchmarks, named in BENCHES: programs that print lines `name value unit` (bench.h); `make bench`
EXTRA_DIST += tests/bench/bench.h tests/bench/precision.dat \
	tests/bench/precision.py tests/bench/scaling.py tests/bench/scaling.dat tests/bench/estimates.py tests/bench/latency.py tests/bench/record.txt \
	tests/bench/peers.py tests/bench/races.py tests/bench/instructions.py tests/bench/chain_truth.c tests/bench/peer_mujoco.cc tests/bench/peer_simbody.cc
