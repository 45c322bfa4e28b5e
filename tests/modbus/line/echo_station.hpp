#pragma once
// A station that answers each request as the wire layer says and keeps what it heard.

#include <vector>

#include "modbus/line/station.hpp"

namespace taktwerk::modbus {

class EchoStation final : public Station {
public:
    explicit EchoStation(std::uint8_t number, LineSettings line = {}) : number_(number), line_(line) {}

    void advance(Instant) override {}
    bool hear(std::span<const std::byte> frame, Instant now, Frame& answer) override {
        const auto heard = parse_request(frame);
        if (heard.error != WireError::none || heard.station != number_) return false;
        heard_at.push_back(now);
        requests.push_back(heard.request);
        answer = encode_response(heard.request, std::span{values}.first(heard.request.count));
        return true;
    }
    [[nodiscard]] Duration turnaround() const noexcept override { return delay; }
    [[nodiscard]] LineSettings line() const noexcept override { return line_; }

    Duration delay = std::chrono::milliseconds{5};
    std::array<std::uint16_t, words_in_frame> values{0x1122, 0x3344};
    std::vector<Instant> heard_at;
    std::vector<Request> requests;

private:
    std::uint8_t number_;
    LineSettings line_;
};

}  // namespace taktwerk::modbus
