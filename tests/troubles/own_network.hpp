#pragma once
// A network of this process alone, with a pair of virtual cables: port0 is the master's, port1 stands for the first slave.

#include <memory>
#include <string>

#include "ecat/transport/raw_socket.hpp"
#include "tests/troubles/bench.hpp"

namespace taktwerk::troubles {

/// False: this system lets nobody make network namespaces or veth pairs.
[[nodiscard]] bool own_network_possible();
/// The pair anew, both ends switched on.
void lay_cable();
bool shell(const std::string& command);

/// The interface is the kernel's, the slaves behind it are simulated: its carrier, its name and its being there are what they are.
class NamedPort final : public ecat::Transport {
public:
    NamedPort(ecat::Transport& slaves, std::unique_ptr<ecat::RawSocketTransport> port) : slaves_(slaves), port_(std::move(port)) {}
    bool send(std::span<const std::byte> frame, Instant now) noexcept override { return link_up() && slaves_.send(frame, now); }
    std::optional<ecat::ReceivedFrame> receive(std::span<std::byte> buffer, Instant now) noexcept override {
        return slaves_.receive(buffer, now);
    }
    [[nodiscard]] ecat::MacAddress mac() const noexcept override { return slaves_.mac(); }
    [[nodiscard]] bool link_up() const noexcept override { return port_->link_up(); }
    [[nodiscard]] std::optional<Error> link_trouble() const override { return port_->link_trouble(); }
    void refresh() noexcept { port_->refresh(); }

private:
    ecat::Transport& slaves_;
    std::unique_ptr<ecat::RawSocketTransport> port_;
};

/// The bench's slaves behind port0, whose link is up.
void put_behind_port(Bench& bench);

}  // namespace taktwerk::troubles
