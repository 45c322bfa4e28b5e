// What the fence of a process (core/process_fence.hpp) costs each system call: the same calls before it is up and behind it. In this order, since a fence
// is for good.

#include <sys/socket.h>
#include <sys/syscall.h>
#include <unistd.h>

#include <array>

#include <benchmark/benchmark.h>

#include "core/process_fence.hpp"

namespace {

struct Pair {
    std::array<int, 2> ends{-1, -1};
    Pair() { (void)::socketpair(AF_UNIX, SOCK_DGRAM, 0, ends.data()); }
    ~Pair() {
        for (const int end : ends) ::close(end);
    }
};

void least_call(benchmark::State& state) {
    for (auto _ : state) benchmark::DoNotOptimize(::syscall(SYS_getppid));
}

/// What a cycle does on a real interface: one frame out, one in.
void send_and_receive(benchmark::State& state) {
    const Pair pair;
    std::array<char, 1500> frame{};
    for (auto _ : state) {
        benchmark::DoNotOptimize(::send(pair.ends[0], frame.data(), frame.size(), 0));
        benchmark::DoNotOptimize(::recv(pair.ends[1], frame.data(), frame.size(), MSG_DONTWAIT));
    }
}

void fenced(benchmark::State& state, void (*calls)(benchmark::State&)) {
    static const bool up = taktwerk::refuse_foreign_system_calls().ok();
    if (!up) state.SkipWithError("no fence");
    else calls(state);
}

BENCHMARK(least_call);
BENCHMARK(send_and_receive);
BENCHMARK_CAPTURE(fenced, least_call, least_call);
BENCHMARK_CAPTURE(fenced, send_and_receive, send_and_receive);

}  // namespace
