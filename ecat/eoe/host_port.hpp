#pragma once
// Where frames of slaves enter this computer: a TAP, or one end of a socket pair in a test. Whole frames, never waiting.

#include <cstddef>
#include <optional>
#include <span>
#include <string>
#include <utility>

#include "core/result.hpp"
#include "ecat/transport/descriptor.hpp"

namespace taktwerk::ecat {

class HostPort {
public:
    /// A descriptor that gives and takes one frame a call, and never blocks.
    explicit HostPort(Descriptor descriptor) noexcept : descriptor_(std::move(descriptor)) {}

    /// A TAP interface of this name, switched on; it is gone with the port. Its address is for whoever uses it to set. Errors: eoe.no_tap
    /// (this system has none), eoe.tap (its name, or a right that is missing).
    [[nodiscard]] static Result<HostPort> open_tap(const std::string& name);

    /// The size of the frame in `buffer`; nothing: none waits.
    [[nodiscard]] std::optional<std::size_t> receive(std::span<std::byte> buffer) noexcept;
    /// False: it was not taken (its queue is full), and is dropped as a switch drops.
    bool send(std::span<const std::byte> frame) noexcept;
    /// Somebody deleted the interface: nothing will ever come or go again.
    [[nodiscard]] bool gone() const noexcept { return gone_; }

private:
    void note_end(int reason) noexcept;

    Descriptor descriptor_;
    bool gone_ = false;
};

}  // namespace taktwerk::ecat
