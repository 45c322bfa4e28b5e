// Any bytes as an answer to the master: it either matches what was asked or changes nothing.
#include <algorithm>
#include <cstdlib>

#include "ecat/exchange/exchange.hpp"

using namespace taktwerk;
using namespace taktwerk::ecat;

namespace {
class Wire final : public Transport {
public:
    std::span<const std::byte> answer;
    bool send(std::span<const std::byte>, Instant) noexcept override { return true; }
    std::optional<ReceivedFrame> receive(std::span<std::byte> buffer, Instant now) noexcept override {
        if (answer.empty()) return std::nullopt;
        const ReceivedFrame received{std::min(answer.size(), buffer.size()), now};
        std::copy_n(answer.begin(), received.size, buffer.begin());
        answer = {};
        return received;
    }
    MacAddress mac() const noexcept override { return {}; }
    bool link_up() const noexcept override { return true; }
};
}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
    Wire wire;
    Exchange exchange{wire};
    const auto slot = *exchange.begin(FrameKind::cyclic);
    (void)exchange.add(slot, Command::BRD, Address::physical(0, 0x0130), 2);
    (void)exchange.add(slot, Command::LRW, Address::logical(0x1000), 4);
    (void)exchange.send(slot, Instant{});
    wire.answer = {reinterpret_cast<const std::byte*>(data), size};
    const bool answered = exchange.receive(Instant{Duration{1}}) == 1;
    if (answered != (exchange.state(slot) == SlotState::answered)) std::abort();
    if (answered && (exchange.data(slot, 0).size() != 2 || exchange.data(slot, 1).size() != 4)) std::abort();
    return 0;
}
