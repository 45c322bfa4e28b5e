// Any bytes as what a client sends to the Modbus TCP server: nothing is read beyond them, each frame has an answer of its own shape, nothing is
// written that is not writable, and what is read is what the image says.
#include <cmath>
#include <cstdlib>
#include <vector>

#include "modbus/server/answer.hpp"

namespace {

using namespace taktwerk::modbus::server;

void must(bool holds) {
    if (!holds) std::abort();
}

/// Two coils, a discrete input, holding 0 (uint16) and 1 (float32), which may be written, holding 8; inputs: a bit of 0, 2 (int32), 65535.
const RegisterMap& offered() {
    static const RegisterMap map{{{"a", Table::coil, 0, NumberType::boolean, WordOrder::high_first, 0, true},
                                  {"b", Table::coil, 1, NumberType::boolean, WordOrder::high_first, 0, true},
                                  {"c", Table::discrete_input, 0, NumberType::boolean, WordOrder::high_first, 0, false},
                                  {"d", Table::holding, 0, NumberType::uint16, WordOrder::high_first, 0, true},
                                  {"e", Table::holding, 1, NumberType::float32, WordOrder::low_first, 0, true},
                                  {"f", Table::holding, 8, NumberType::int16, WordOrder::high_first, 0, false},
                                  {"g", Table::input, 0, NumberType::boolean, WordOrder::high_first, 5, false},
                                  {"h", Table::input, 2, NumberType::int32, WordOrder::high_first, 0, false},
                                  {"i", Table::input, 65535, NumberType::uint16, WordOrder::high_first, 0, false}}};
    return map;
}

/// The words of an answer that was read are those of its registers.
void compare(const Request& request, const ServedImage& image, const AnswerFrame& frame) {
    const auto places = offered().find(request.table, request.address, request.count);
    must(places.has_value());
    const auto pdu = frame.span().subspan(header_bytes);
    must(pdu.size() == 2u + pdu[1]);
    for (const auto& place : *places) {
        const std::size_t offset = place.address - request.address;
        if (is_bits(request.table)) must((pdu[2 + offset / 8] >> (offset % 8) & 1) == image.words[place.index][0]);
        else must((pdu[2 + 2 * offset] << 8 | pdu[3 + 2 * offset]) == image.words[place.index][0]);
    }
}

void answer(const Frame& frame, const ServedImage& image) {
    const AnswerTo to{frame.transaction, frame.unit, frame.pdu[0]};
    const auto heard = hear(frame.pdu);
    AnswerFrame out;
    if (heard.exception != Exception::none) {
        out = refusal(to, heard.exception);
    } else if (heard.request.writes) {
        const auto asked = changes_of(offered(), heard.request);
        for (const auto& change : asked.changes) must(offered().registers()[change.index].writable && std::isfinite(change.number));
        must(asked.exception != Exception::none || !asked.changes.empty());
        out = asked.exception == Exception::none ? written(to, heard.request) : refusal(to, asked.exception);
    } else {
        const auto read = answer_read(offered(), image, to, heard.request);
        if (read.exception == Exception::none) compare(heard.request, image, read.frame);
        out = read.frame;
    }
    const auto bytes = out.span();
    must(bytes.size() >= header_bytes + 2 && bytes.size() <= most_frame_bytes);
    must((bytes[4] << 8 | bytes[5]) + 6u == bytes.size());
    must((bytes[0] << 8 | bytes[1]) == frame.transaction && bytes[6] == frame.unit && (bytes[7] & 0x7F) == (frame.pdu[0] & 0x7F));
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
    ServedImage image;
    for (const auto& one : offered().registers()) image.words.push_back(words_of(one, 1));
    std::vector<std::uint8_t> bytes(data, data + size);  // of its own size: a step beyond it is seen
    std::span<const std::uint8_t> left{bytes};
    for (auto frame = frame_of(left); frame.state == Frame::State::whole; frame = frame_of(left)) {
        must(frame.bytes <= left.size() && frame.pdu.size() + header_bytes == frame.bytes);
        answer(frame, image);
        left = left.subspan(frame.bytes);
    }
    if (!bytes.empty()) answer({Frame::State::whole, 1, 1, bytes, 0}, image);  // and as a PDU alone, however long
    return 0;
}
