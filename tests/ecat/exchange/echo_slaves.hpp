#pragma once
// The simplest bus there is: slaves that count, mark the frame as a real controller does, and let a test tamper with it.

#include <functional>
#include <optional>
#include <span>
#include <vector>

#include "core/bytes.hpp"
#include "ecat/transport/loopback.hpp"

namespace taktwerk::ecat::test {

class EchoSlaves final : public FrameSink {
public:
    std::uint16_t count = 2;  ///< slaves on the cable
    Duration flight = std::chrono::microseconds{10};
    bool sets_mac_bit = true;                          ///< real controllers do; some emulators do not
    std::function<void(std::span<std::byte>)> tamper;  ///< last change to the answer
    std::vector<std::vector<std::byte>> seen;          ///< frames as they came from the master
    Instant advanced{};

    void advance(Instant now) noexcept override {
        if (now > advanced) advanced = now;
    }

    std::optional<Duration> process(std::span<std::byte> frame, Instant) noexcept override {
        seen.emplace_back(frame.begin(), frame.end());
        FrameEditor editor{frame};
        while (auto datagram = editor.next()) {
            switch (datagram->command) {
                case Command::APRD:
                case Command::APWR:
                case Command::APRW:
                case Command::ARMW:
                case Command::BRD:
                case Command::BWR:
                case Command::BRW:
                    store_le<std::uint16_t>(datagram->header, 2, static_cast<std::uint16_t>(datagram->address.adp() + count));
                    break;
                default: break;
            }
            for (auto& byte : datagram->data) byte |= std::byte{0x80};
            store_le<std::uint16_t>(datagram->wkc, 0, count);
        }
        if (sets_mac_bit) frame[6] |= std::byte{0x02};
        if (tamper) tamper(frame);
        return flight;
    }
};

}  // namespace taktwerk::ecat::test
