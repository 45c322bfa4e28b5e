// What a ring of two interfaces costs beside the sending and receiving itself: to put the two halves of a broken ring together, and the whole way of
// a frame through the ring, closed and broken. One LRW of so many bytes behind an 8-byte FRMW and before a BRD, as in a cycle.

#include <array>
#include <optional>
#include <utility>

#include <benchmark/benchmark.h>

#include "ecat/ring/ring_transport.hpp"
#include "ecat/wire/frame.hpp"
#include "ecat/wire/registers.hpp"

namespace taktwerk::ecat {
namespace {

using Frame = std::array<std::byte, max_frame_size>;

std::size_t build(Frame& frame, std::size_t data, const MacAddress& source) {
    FrameBuilder builder{frame, source};
    builder.add(Command::FRMW, 1, Address::physical(0x1001, reg::dc_system_time), 8);
    builder.add(Command::LRW, 2, Address::logical(0), data);
    builder.add(Command::BRD, 3, Address::physical(0, reg::al_status), 2);
    return builder.finish().size();
}

void merge_two_halves(benchmark::State& state) {
    Frame sent{}, first{}, second{}, out{};
    const auto size = build(sent, static_cast<std::size_t>(state.range(0)), {0, 1, 2, 3, 4, 5});
    first = second = out = sent;
    for (std::size_t i = 60; i < size / 2; ++i) first[i] = static_cast<std::byte>(i);
    for (auto _ : state) {
        const auto whole = [&](const Frame& frame) { return std::span<const std::byte>{frame}.first(size); };
        merge({whole(sent), whole(first)}, {whole(sent), whole(second)}, std::span{out}.first(size));
        benchmark::DoNotOptimize(out.data());
        benchmark::ClobberMemory();
    }
}

/// Keeps one frame and gives it back here or at the other end.
class Wire final : public Transport {
public:
    bool send(std::span<const std::byte> frame, Instant) noexcept override {
        Wire& at = elsewhere != nullptr ? *elsewhere : *this;
        std::copy(frame.begin(), frame.end(), at.frame_.begin());
        if (passes_slaves) at.frame_[6] |= std::byte{2};
        at.size_ = frame.size();
        return true;
    }
    std::optional<ReceivedFrame> receive(std::span<std::byte> buffer, Instant now) noexcept override {
        if (size_ == 0) return std::nullopt;
        std::copy_n(frame_.begin(), size_, buffer.begin());
        return ReceivedFrame{std::exchange(size_, 0), now};
    }
    [[nodiscard]] MacAddress mac() const noexcept override { return {0, 1, 2, 3, 4, 5}; }
    [[nodiscard]] bool link_up() const noexcept override { return true; }
    Wire* elsewhere = nullptr;
    bool passes_slaves = true;

private:
    Frame frame_{};
    std::size_t size_ = 0;
};

template <class Bus>
void round(benchmark::State& state, Bus& bus) {
    Frame frame{}, back{};
    const auto size = build(frame, static_cast<std::size_t>(state.range(0)), {0, 1, 2, 3, 4, 5});
    for (auto _ : state) {
        bus.send(std::span<const std::byte>{frame}.first(size), Instant{});
        while (const auto received = bus.receive(back, Instant{})) benchmark::DoNotOptimize(received->size);
    }
}

void one_interface(benchmark::State& state) {
    Wire wire;
    round(state, wire);
}
void ring_closed(benchmark::State& state) {
    Wire first, second;
    first.elsewhere = &second;
    second.elsewhere = &first;
    second.passes_slaves = false;
    RingTransport ring{first, second, std::chrono::microseconds{250}};
    round(state, ring);
}
void ring_broken(benchmark::State& state) {
    Wire first, second;
    RingTransport ring{first, second, std::chrono::microseconds{250}};
    round(state, ring);
}

BENCHMARK(merge_two_halves)->Arg(64)->Arg(512)->Arg(1400);
BENCHMARK(one_interface)->Arg(64)->Arg(512)->Arg(1400);
BENCHMARK(ring_closed)->Arg(64)->Arg(512)->Arg(1400);
BENCHMARK(ring_broken)->Arg(64)->Arg(512)->Arg(1400);

}  // namespace
}  // namespace taktwerk::ecat
