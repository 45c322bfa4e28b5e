#pragma once
// Short messages to a local datagram socket of the system (service manager, journal). Nothing here waits: what is not taken at once is not sent.

#include <string>
#include <string_view>

namespace taktwerk::apps {

class DatagramOut {
public:
    DatagramOut() = default;
    /// `address`: a path, or @NAME of the abstract name space (sd_notify(3)). An address that cannot be one sends nothing.
    explicit DatagramOut(std::string_view address);
    ~DatagramOut();
    DatagramOut(DatagramOut&& other) noexcept;
    DatagramOut& operator=(DatagramOut&& other) noexcept;

    [[nodiscard]] bool open() const noexcept { return socket_ >= 0; }
    /// Any thread. False: nobody took it.
    bool send(std::string_view message) const noexcept;

private:
    std::string address_;
    int socket_ = -1;
};

}  // namespace taktwerk::apps
