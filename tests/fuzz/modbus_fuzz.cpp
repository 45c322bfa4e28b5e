// Any bytes as a Modbus request and as the answer to each kind of request: nothing is read beyond them, and what was understood is
// encoded into the same bytes again. As they are, and with the right CRC behind them, which chance would hardly find.
#include <algorithm>
#include <cstdlib>
#include <vector>

#include "modbus/wire/crc.hpp"
#include "modbus/wire/frame.hpp"

using namespace taktwerk::modbus;

namespace {

void hear(std::span<const std::byte> frame) {
    const auto heard = parse_request(frame);
    if (heard.error == WireError::none) {
        const auto again = encode(heard.request);
        if (!std::equal(frame.begin(), frame.end(), again.span().begin(), again.span().end())) std::abort();
        // An answer made for it is understood as one.
        if (heard.request.count <= words_in_frame) {
            const std::vector<std::uint16_t> words(heard.request.count, 0x1234);
            Response response;
            if (parse_response(encode_response(heard.request, words).span(), heard.request, response) != WireError::none) std::abort();
        }
    }
    (void)frame_length(Direction::request, frame);
    (void)frame_length(Direction::response, frame);
    const std::uint16_t words[] = {1, 2};
    for (const auto& request : {read_parameters(1, 0, 2), read_status(1, 5, 8), write_parameter(1, 138, 100), diagnose(1, 0x1234),
                                write_parameters(1, 138, words), save(1), servo(1, servo_on), clear_alarm(1)}) {
        Response response;
        if (parse_response(frame, request, response) == WireError::none && response.count > words_in_frame) std::abort();
    }
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
    std::vector<std::byte> frame(reinterpret_cast<const std::byte*>(data), reinterpret_cast<const std::byte*>(data) + size);
    hear(frame);
    const auto crc = crc16(frame);
    frame.push_back(static_cast<std::byte>(crc & 0xFF));
    frame.push_back(static_cast<std::byte>(crc >> 8));
    hear(frame);
    return 0;
}
