#pragma once
// A bus on which a trouble is staged: slaves as a file says, slaves as they stand on the cable, and a master that reaches those through
// frames alone. The slaves of a file are called a, b, c, ... in their order.
//
//   s  servo with CoE and a clock, refuses SAFEOP without SYNC0      v  the same of another vendor
//   t  terminal, 8 inputs and 8 outputs, without a mailbox           p  the same type, another product
//   m  modular slave with two slots                                  r  the same product in another revision
//   o  coupler without process data
//   k  coupler, gives 500 mA to the E-bus                            e  terminal on the E-bus, takes 300 mA
//
// Servos that are not what their type says:
//   n  its controller has no clock                                   x  its mailboxes are of 256 bytes
//   y  it knows a cycle of 2 ms only                                 f  1702h has other entries in its firmware
//   l  it limits 6085h to 1000

#include <memory>
#include <string_view>
#include <vector>

#include "ecat/diagnosis/bus_probe.hpp"
#include "tests/ecat/test_bus.hpp"
#include "tests/troubles/trouble.hpp"

namespace taktwerk::troubles {

using namespace std::chrono_literals;

class Bench : public ecat::test::TestBus {
public:
    Bench(std::string_view configured, std::string_view there);
    ~Bench() { master.reset(); }  // before its port

    /// Of the file: slave 'b'.
    [[nodiscard]] ecat::SlaveConfig& file(char name) { return config.slaves[place(name)]; }
    /// What the file says of its device; changing it changes nobody else.
    [[nodiscard]] ecat::DeviceDescription& described(char name);
    /// Who stands where 'b' should.
    [[nodiscard]] ecat::sim::SimSlave& there(char name) { return network.slave(place(name)); }
    /// Another slave at the end of the cable.
    ecat::sim::SimSlave& plug_in(char kind, ecat::sim::SlaveOptions options = {});
    /// The same with the cable from the master in its OUT socket.
    void plug_in_backwards(char kind);
    void write_startup(char name, std::uint16_t index, std::int64_t value);

    [[nodiscard]] std::vector<Said> what_check_says() const;
    [[nodiscard]] std::vector<Said> what_scan_says();
    [[nodiscard]] std::vector<Said> what_why_says();
    /// Of the two seconds from now on, and of what a standard gives the slave before.
    [[nodiscard]] std::vector<Said> what_alarms_say(Duration patience);

    std::unique_ptr<ecat::Transport> port;  ///< of the kernel, in the place of the plain cable (own_network.hpp)

private:
    [[nodiscard]] static std::size_t place(char name) noexcept { return static_cast<std::size_t>(name - 'a'); }
    [[nodiscard]] ecat::BusProbe looking();
    /// As the commands do before they begin.
    [[nodiscard]] std::vector<Said> wrong_links_said();
    [[nodiscard]] std::vector<Said> notes_said(Instant began) const;
    void hear(std::vector<Said>& said, Instant since);
};

}  // namespace taktwerk::troubles
