// Any messages as what a slave answers to a file that is written or read, and as what a master asks a simulated slave for: what was read
// writes back, no conversation takes more than it was given. Input: messages [size, bytes].
#include <algorithm>
#include <cstdlib>
#include <vector>

#include "ecat/foe/file_reading.hpp"
#include "ecat/foe/file_writing.hpp"
#include "ecat/sim/foe_server.hpp"
#include "ecat/wire/foe.hpp"
#include "ecat/wire/foe_error.hpp"

using namespace taktwerk;
using namespace taktwerk::ecat;

namespace {

constexpr std::size_t room = 16, limit = 100;

void writes_back(std::span<const std::byte> payload, const FoeMessage& message) {
    std::vector<std::byte> out(payload.size());
    if (encode_foe(out, message) != payload.size()) std::abort();
    const auto again = parse_foe(out);
    if (!again || again->op != message.op || again->number != message.number || again->text() != message.text()) std::abort();
    if (foe_error_info(message.number).text.empty()) std::abort();
}

/// A step that goes on has a request that fits; one that failed says why.
template <class Conversation>
void converse_with(Conversation& conversation, const FoeMessage& message, bool& over) {
    if (over) return;
    const auto before = conversation.request();
    const auto step = conversation.answer(message);
    if (step.kind == FoeStep::Kind::broken && (step.words.empty() || step.code == 0)) std::abort();
    if (step.kind == FoeStep::Kind::skip && conversation.request().number != before.number) std::abort();
    if (conversation.request().op == FoeOp::data && conversation.request().rest.size() > room) std::abort();
    over = step.kind == FoeStep::Kind::done || step.kind == FoeStep::Kind::last || step.kind == FoeStep::Kind::refused ||
           step.kind == FoeStep::Kind::broken;
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
    static const std::vector<std::byte> content(50, std::byte{7});
    FileWriting writing{{"firmware", 1}, content, room};
    FileReading reading{{"firmware", 1}, room, limit};
    bool written = false, read = false;
    sim::FirmwareOptions options;
    options.capacity = 256;
    options.factory_size = 64;
    sim::SlaveFiles files{{1, 2, 3, 0}, options};
    sim::FoeServer server{files};
    server.set_rooms(room + foe_header_size, room + foe_header_size);
    server.start();
    std::vector<std::byte> out(room + foe_header_size);
    Instant now{};
    for (std::size_t at = 0, n = 0; at < size && n < 200; ++n) {
        const std::size_t length = std::min<std::size_t>(data[at], size - at - 1);
        const std::span<const std::byte> payload{reinterpret_cast<const std::byte*>(data + at + 1), length};
        at += 1 + length;
        now += std::chrono::milliseconds{20};
        const auto state = n % 2 == 0 ? sim::EsmState::boot : sim::EsmState::preop;
        const auto answered = server.serve(payload, out, state, now);
        if (answered > out.size() || (answered > 0 && !parse_foe(std::span{out}.first(answered)))) std::abort();
        const auto message = parse_foe(payload);
        if (!message) continue;
        writes_back(payload, *message);
        converse_with(writing, *message, written);
        converse_with(reading, *message, read);
        if (writing.acknowledged() > content.size() || reading.file().size() > limit) std::abort();
    }
    return 0;
}
