#pragma once
// A half-duplex line as its host sees it: frames go out whole, bytes come in as they arrive. Nothing here waits; the time is handed in.
// One thread (the service side), not real-time.

#include <cstddef>
#include <span>

#include "core/time.hpp"
#include "modbus/line/line_settings.hpp"

namespace taktwerk::modbus {

class SerialLine {
public:
    virtual ~SerialLine() = default;

    [[nodiscard]] virtual const LineSettings& settings() const noexcept = 0;
    /// Starts sending. False: the port is not there now; it is tried again with the next frame.
    virtual bool send(std::span<const std::byte> frame, Instant now) = 0;
    /// What has arrived by `now` and was not fetched before, in order; returns how many bytes.
    virtual std::size_t receive(std::span<std::byte> into, Instant now) = 0;
    /// Forgets what has arrived: called before a question, so that a late answer to an older one is not taken for this one's, and whenever
    /// nothing is asked.
    virtual void discard(Instant now) = 0;
    /// The port could be opened and has not failed since.
    [[nodiscard]] virtual bool present() const noexcept = 0;
};

}  // namespace taktwerk::modbus
