#pragma once
// What all `taktwerk bus` sub-commands share: which bus (a network interface, or the simulated one of a machine file), what is
// configured there, and the running of scripts on it in real or virtual time.

#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <string_view>

#include <nlohmann/json.hpp>

#include "apps/terminal/text_table.hpp"
#include "core/clock.hpp"
#include "core/result.hpp"
#include "ecat/diagnosis/bus_probe.hpp"
#include "ecat/diagnosis/survey.hpp"
#include "ecat/recording/frame_capture.hpp"
#include "ecat/ring/bus_interfaces.hpp"
#include "runtime/world/world.hpp"

namespace taktwerk::apps {

using Json = nlohmann::ordered_json;

struct BusOptions {
    std::string nic, machine, pcap;
    bool simulate = false, json = false;
    bool operational = false;  ///< bring the bus to OP first
    bool yes = false;          ///< nobody is asked before outputs are driven
    bool force = false;        ///< also while another master is on the cable
};

class BusSession {
public:
    ~BusSession();
    BusSession(const BusSession&) = delete;
    BusSession& operator=(const BusSession&) = delete;

    /// "eth1", "simulated bus of 'demo'".
    [[nodiscard]] const std::string& where() const noexcept { return where_; }
    [[nodiscard]] Instant now() const { return clock_->now(); }
    [[nodiscard]] bool simulated() const noexcept { return world_ != nullptr; }
    /// As a machine file names them. The second one: empty where the bus is looked at as a line.
    [[nodiscard]] std::string interface() const { return simulated() ? "simulated" : nic_->first(); }
    [[nodiscard]] std::string second_interface() const {
        if (!configured_.ring || !options_.nic.empty()) return {};
        return simulated() ? "simulated" : configured_.ring->interface2;
    }
    /// What the machine file says; empty without one.
    [[nodiscard]] const ecat::BusConfig& configured() const noexcept { return configured_; }
    [[nodiscard]] ecat::BusProbe& probe() noexcept { return *probe_; }
    [[nodiscard]] ecat::Bus& bus() noexcept { return probe_->bus(); }

    /// Who is there, compared with the machine file. On a real bus it listens first whether another master is on the cable.
    [[nodiscard]] Result<ecat::Survey> look();
    /// An error when another master uses this bus, a warning (printed) when slaves are in OP without anybody being heard.
    [[nodiscard]] Result<void> may_write(const ecat::Survey& survey, std::string_view doing);
    /// An error when another master is heard, whatever --force says: for what no two may do.
    [[nodiscard]] Result<void> must_be_alone(std::string_view doing) const;
    /// From now on bus().slaves are the surveyed ones, one for each that could be read, in the order of the cable.
    void adopt(const ecat::Survey& survey);
    /// To OP as the machine would, or with what the slaves say of themselves when no machine is given; asks before.
    [[nodiscard]] Result<void> bring_up(const ecat::Survey& survey);
    /// Asks on the terminal whether slaves may be operated. Without a terminal only --yes counts.
    [[nodiscard]] Result<void> confirm_operation(const ecat::Survey& survey);
    /// From now on Ctrl-C ends nothing: for what must be put back before the end.
    void finish_undisturbed() noexcept { closing_ = true; }
    /// Down to INIT if bring_up() got it up; the capture is finished. Also after Ctrl-C.
    [[nodiscard]] Result<void> close();

private:
    friend struct BusOpening;
    explicit BusSession(BusOptions options);
    [[nodiscard]] std::optional<Instant> next_round(Duration period);
    [[nodiscard]] Result<void> let_groups_join();
    void new_probe(ecat::BusConfig config);
    [[nodiscard]] ecat::Transport& transport() noexcept { return world_ ? world_->bus() : nic_->bus(); }

    BusOptions options_;
    std::string where_;
    ecat::BusConfig configured_;
    std::unique_ptr<Clock> clock_;
    std::unique_ptr<runtime::World> world_;
    std::unique_ptr<ecat::BusInterfaces> nic_;
    std::unique_ptr<ecat::FrameCapture> capture_;
    std::unique_ptr<ecat::BusProbe> probe_;
    Instant deadline_{};
    Instant next_refresh_{};
    std::uint64_t foreign_frames_ = 0;
    std::string foreign_sender_;
    std::string machine_socket_;  ///< that the machine file names; where its machine would be if it ran
    bool up_ = false, closing_ = false;
};

/// Opens the bus that the options name; `work` returns the exit code. Prints every error, as text or as JSON, also those of the
/// file and of closing.
int with_bus(const BusOptions& options, const std::function<int(BusSession&)>& work);

/// Prints it as the options want and gives the exit code it stands for.
int fail(const BusOptions& options, const Error& error);
[[nodiscard]] int exit_code_for(const Error& error);
/// The same as part of an answer.
[[nodiscard]] Json error_json(const Error& error);
/// One line on standard output.
void print_json(const Json& json);

/// Position of the slave that a user calls "2" or "y_drive". Error bus.no_such_slave.
[[nodiscard]] Result<std::size_t> find_slave(const ecat::Survey& survey, const std::string& word);
/// The adopted or brought-up slave at a position. Error: that of its survey, or bus.not_configured.
[[nodiscard]] Result<ecat::BusSlave*> slave_at(BusSession& session, const ecat::Survey& survey, std::size_t position);

}  // namespace taktwerk::apps
