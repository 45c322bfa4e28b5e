#pragma once
// The network interfaces of one bus, opened: one, or two that are a ring. Not real-time but for what bus() gives.

#include <array>
#include <memory>
#include <string>
#include <vector>

#include "core/result.hpp"
#include "ecat/bus_transport.hpp"
#include "ecat/ring/ring_transport.hpp"
#include "ecat/transport/raw_socket.hpp"
#include "ecat/transport/xdp_transport.hpp"

namespace taktwerk::ecat {

class BusInterfaces {
public:
    /// `second` empty: no ring. `patience` as RingTransport has it. Errors: those of RawSocketTransport::open(), and with BusTransport::xdp
    /// those of XdpTransport::open().
    static Result<std::unique_ptr<BusInterfaces>> open(const std::string& first, const std::string& second, Duration patience,
                                                       BusTransport by = BusTransport::packet, const RawSocketOptions& options = {});

    [[nodiscard]] Transport& bus() noexcept { return ring_ ? static_cast<Transport&>(*ring_) : ends_[0].transport(); }
    [[nodiscard]] const std::string& first() const noexcept { return ends_[0].packet->interface(); }
    /// As RawSocketTransport has it, of both.
    void refresh() noexcept;
    /// By what the frames go where that is not a packet socket, or was not to be; what was asked of the kernel and refused: "eth1: ...".
    [[nodiscard]] std::vector<std::string> remarks() const;
    /// What has come to light since open(), each once; mostly nothing. Of the thread that calls refresh().
    [[nodiscard]] std::vector<std::string> news();

private:
    struct End {
        std::unique_ptr<RawSocketTransport> packet;
        std::unique_ptr<XdpTransport> xdp;  ///< beside it; null: the packet socket alone
        std::string instead;                ///< why it is null although it was tried
        [[nodiscard]] Transport& transport() noexcept { return xdp ? static_cast<Transport&>(*xdp) : *packet; }
    };
    BusInterfaces() = default;
    static Result<End> open_end(const std::string& interface, BusTransport by, const RawSocketOptions& options);

    std::array<End, 2> ends_;
    std::unique_ptr<RingTransport> ring_;
};

}  // namespace taktwerk::ecat
