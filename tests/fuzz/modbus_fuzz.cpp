// Any bytes as a Modbus request and as the answer to each kind of request: nothing is read beyond them, and what was understood is
// encoded into the same bytes again.
#include <algorithm>
#include <cstdlib>
#include <vector>

#include "modbus/wire/frame.hpp"

using namespace taktwerk::modbus;

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
    std::vector<std::byte> frame(reinterpret_cast<const std::byte*>(data), reinterpret_cast<const std::byte*>(data) + size);
    const auto heard = parse_request(frame);
    if (heard.error == WireError::none) {
        const auto again = encode(heard.request);
        if (!std::equal(frame.begin(), frame.end(), again.span().begin(), again.span().end())) std::abort();
    }
    (void)frame_length(Direction::request, frame);
    (void)frame_length(Direction::response, frame);
    const std::uint16_t words[] = {1, 2};
    for (const auto& request : {read_parameters(1, 0, 2), read_status(1, 5, 8), write_parameter(1, 138, 100), diagnose(1, 0x1234),
                                write_parameters(1, 138, words), save(1), servo(1, servo_on), clear_alarm(1)}) {
        Response response;
        if (parse_response(frame, request, response) == WireError::none && response.count > words_in_frame) std::abort();
    }
    return 0;
}
