// Any bytes on the serial line while the host asks: each question gets exactly one answer, in bounded time, and an answer that counts has
// the words that were asked for. Input: [question], then what arrives: [milliseconds from then on, size, bytes], as it stands or (size odd)
// with the right check at its end.
#include <algorithm>
#include <cstdlib>
#include <vector>

#include "modbus/client/client.hpp"
#include "modbus/wire/crc.hpp"

using namespace taktwerk;
using namespace taktwerk::modbus;
using namespace std::chrono_literals;

namespace {

class Line final : public SerialLine {
public:
    std::vector<std::byte> arrived;
    [[nodiscard]] const LineSettings& settings() const noexcept override { return settings_; }
    bool send(std::span<const std::byte>, Instant) override { return true; }
    std::size_t receive(std::span<std::byte> into, Instant) override {
        const auto taken = std::min(into.size(), arrived.size());
        std::copy_n(arrived.begin(), taken, into.begin());
        arrived.erase(arrived.begin(), arrived.begin() + static_cast<std::ptrdiff_t>(taken));
        return taken;
    }
    void discard(Instant) override { arrived.clear(); }
    [[nodiscard]] bool present() const noexcept override { return true; }

private:
    LineSettings settings_;
};

Request question(std::uint8_t what) {
    static constexpr std::uint16_t values[] = {1, 2, 3};
    switch (what % 6) {
        case 0: return read_parameters(1, 4, 8);
        case 1: return read_status(1, 0, 3);
        case 2: return write_parameter(1, 4, 100);
        case 3: return write_parameters(1, 4, values);
        case 4: return clear_alarm(1);
        default: return diagnose(1, 0x1234);
    }
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
    if (size == 0) return 0;
    Line line;
    Client client{line};
    Instant now{1s};
    const auto asked = question(data[0]);
    if (client.ask(asked, now) != Refusal::none) std::abort();
    std::size_t at = 1;
    auto wait = at < size ? data[at++] % 64 : 0;
    for (int step = 0; step < 1000; ++step) {
        now += 1ms;
        if (wait-- == 0 && at < size) {
            const bool checked = (data[at] & 1) != 0;
            const std::size_t length = std::min<std::size_t>(data[at] / 2, size - at - 1);
            const auto* from = reinterpret_cast<const std::byte*>(data + at + 1);
            line.arrived.insert(line.arrived.end(), from, from + length);
            if (checked) {
                const auto check = crc16({from, length});
                line.arrived.push_back(static_cast<std::byte>(check & 0xFF));
                line.arrived.push_back(static_cast<std::byte>(check >> 8));
            }
            at += 1 + length;
            wait = at < size ? data[at++] % 64 : -1;
        }
        const auto answer = client.step(now);
        if (!answer) continue;
        if (answer->request.function != asked.function || answer->request.address != asked.address) std::abort();
        const bool reads = asked.function == Function::read_parameters || asked.function == Function::read_status;
        if (answer->outcome == Outcome::answered && reads && answer->response.count != asked.count) std::abort();
        if ((answer->outcome == Outcome::exception) != (answer->response.exception != ExceptionCode::none)) std::abort();
        if (answer->took < 0ms) std::abort();
        if (client.step(now)) std::abort();
        return 0;
    }
    std::abort();  // the host waits for ever
}
