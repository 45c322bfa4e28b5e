#pragma once
// A serial port of this PC (/dev/ttyS0, /dev/ttyUSB0) in raw mode, never waiting. The direction of an RS-485 transceiver is the adapter's business.
// A port that vanishes (an adapter pulled out) is opened again, at most once a second.

#include <memory>
#include <string>

#include "core/result.hpp"
#include "modbus/line/serial_line.hpp"

namespace taktwerk::modbus {

class TtyLine final : public SerialLine {
public:
    /// Errors: serial.open (not there, not permitted, in use by another program), serial.settings (it does not take the baud rate).
    static Result<std::unique_ptr<TtyLine>> open(std::string device, const LineSettings& settings);
    ~TtyLine() override;
    TtyLine(const TtyLine&) = delete;
    TtyLine& operator=(const TtyLine&) = delete;

    [[nodiscard]] const LineSettings& settings() const noexcept override { return settings_; }
    bool send(std::span<const std::byte> frame, Instant now) override;
    std::size_t receive(std::span<std::byte> into, Instant now) override;
    void discard(Instant now) override;
    [[nodiscard]] bool present() const noexcept override { return descriptor_ >= 0; }

private:
    TtyLine(std::string device, const LineSettings& settings) : device_(std::move(device)), settings_(settings) {}
    Result<void> open_now();
    void reopen(Instant now);
    void failed(Instant now) noexcept;

    std::string device_;
    LineSettings settings_;
    int descriptor_ = -1;
    Instant try_again_{};
};

/// Raw mode with these settings on an open terminal. Error: serial.settings.
[[nodiscard]] Result<void> set_raw(int descriptor, const LineSettings& settings, const std::string& device);

}  // namespace taktwerk::modbus
