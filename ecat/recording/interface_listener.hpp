#pragma once
// Hears every EtherCAT frame on a network interface, those that leave and those that come, and says nothing: beside a master that works there, or at
// a tap in somebody else's cable. Linux only; not real-time.

#include <memory>
#include <optional>
#include <span>
#include <string>
#include <string_view>

#include "core/result.hpp"
#include "core/time.hpp"
#include "ecat/transport/descriptor.hpp"

namespace taktwerk::ecat {

class InterfaceListener {
public:
    /// Errors: those of find_interface() and open_packet_socket().
    [[nodiscard]] static Result<std::unique_ptr<InterfaceListener>> open(std::string_view interface);

    struct Heard {
        std::span<const std::byte> frame;  ///< until the next call
        Duration since_1970{};             ///< by the kernel's stamp
        bool outgoing = false;             ///< of this computer
    };
    /// The next one; nothing when none comes within `patience`, or a signal came.
    [[nodiscard]] std::optional<Heard> next(Duration patience);
    /// Frames that the kernel had no room for since the last call.
    [[nodiscard]] std::uint64_t missed();

    [[nodiscard]] const std::string& interface() const noexcept { return interface_; }

private:
    InterfaceListener(std::string interface, Descriptor socket);

    std::string interface_;
    Descriptor socket_;
    std::unique_ptr<std::byte[]> buffer_;
};

}  // namespace taktwerk::ecat
