#pragma once
// The network interfaces of one bus, opened: one, or two that are a ring. Not real-time but for what bus() gives.

#include <memory>
#include <string>
#include <vector>

#include "core/result.hpp"
#include "ecat/ring/ring_transport.hpp"
#include "ecat/transport/raw_socket.hpp"

namespace taktwerk::ecat {

class BusInterfaces {
public:
    /// `second` empty: no ring. `patience` as RingTransport has it. Errors: those of RawSocketTransport::open().
    static Result<std::unique_ptr<BusInterfaces>> open(const std::string& first, const std::string& second, Duration patience,
                                                       const RawSocketOptions& options = {});

    [[nodiscard]] Transport& bus() noexcept { return ring_ ? static_cast<Transport&>(*ring_) : *first_; }
    [[nodiscard]] RawSocketTransport& first() noexcept { return *first_; }
    /// As RawSocketTransport has it, of both.
    void refresh() noexcept;
    /// What was asked of the kernel and refused: "eth1: ...".
    [[nodiscard]] std::vector<std::string> refused() const;

private:
    BusInterfaces() = default;
    std::unique_ptr<RawSocketTransport> first_, second_;
    std::unique_ptr<RingTransport> ring_;
};

}  // namespace taktwerk::ecat
