// What a datagram of 32 bytes costs in ecat/wire/: build a frame of them; walk it; walk it and check what an answer is checked
// for (command, index, address, length, working counter). Per datagram, frames of 1 and of 34 (as many as fit).

#include <array>

#include <benchmark/benchmark.h>

#include "ecat/wire/frame.hpp"

namespace taktwerk::ecat {
namespace {

constexpr std::size_t data_size = 32;
constexpr MacAddress mac{0x00, 0x54, 0x57, 0, 0, 1};
using Buffer = std::array<std::byte, max_frame_size>;

std::span<const std::byte> build(Buffer& buffer, std::size_t datagrams) {
    FrameBuilder builder{buffer, mac};
    for (std::size_t i = 0; i < datagrams; ++i) {
        const auto data =
            builder.add(Command::LRW, static_cast<std::uint8_t>(i), Address::logical(static_cast<std::uint32_t>(i * data_size)), data_size);
        benchmark::DoNotOptimize(data.data());
    }
    return builder.finish();
}

void per_datagram(benchmark::State& state) {
    state.counters["per datagram"] = benchmark::Counter(static_cast<double>(state.iterations()) * static_cast<double>(state.range(0)),
                                                        benchmark::Counter::kIsRate | benchmark::Counter::kInvert);
}

void build_frame(benchmark::State& state) {
    Buffer buffer;
    for (auto _ : state) benchmark::DoNotOptimize(build(buffer, static_cast<std::size_t>(state.range(0))).data());
    per_datagram(state);
}

void parse_frame(benchmark::State& state) {
    Buffer buffer;
    const auto frame = build(buffer, static_cast<std::size_t>(state.range(0)));
    for (auto _ : state) {
        FrameReader reader{frame};
        std::size_t bytes = 0;
        while (const auto datagram = reader.next()) bytes += datagram->data.size();
        benchmark::DoNotOptimize(bytes);
    }
    per_datagram(state);
}

void parse_and_check_frame(benchmark::State& state) {
    Buffer buffer;
    const auto frame = build(buffer, static_cast<std::size_t>(state.range(0)));
    for (auto _ : state) {
        FrameReader reader{frame};
        std::uint32_t i = 0;
        bool exact = true;
        while (const auto datagram = reader.next()) {
            exact &= datagram->command == Command::LRW && datagram->index == static_cast<std::uint8_t>(i) &&
                     datagram->address == Address::logical(static_cast<std::uint32_t>(i * data_size)) &&
                     datagram->data.size() == data_size && datagram->working_counter() == 0;
            ++i;
        }
        exact &= reader.error() == FrameError::none;
        benchmark::DoNotOptimize(exact);
    }
    per_datagram(state);
}

BENCHMARK(build_frame)->Arg(1)->Arg(34);
BENCHMARK(parse_frame)->Arg(1)->Arg(34);
BENCHMARK(parse_and_check_frame)->Arg(1)->Arg(34);

}  // namespace
}  // namespace taktwerk::ecat
