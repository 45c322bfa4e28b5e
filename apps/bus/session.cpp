#include "apps/bus/session.hpp"

#include <unistd.h>

#include <algorithm>
#include <charconv>
#include <chrono>
#include <cstdio>
#include <iostream>

#include <fmt/format.h>

#include "apps/machine/load.hpp"
#include "apps/machine/remote.hpp"
#include "apps/machine/running_machine.hpp"
#include "apps/machine/stop_signal.hpp"
#include "apps/terminal/exit_code.hpp"
#include "apps/terminal/print_error.hpp"
#include "core/calendar_distance.hpp"
#include "core/clock.hpp"
#include "ecat/bringup/presence.hpp"
#include "ecat/diagnosis/derived_config.hpp"
#include "ecat/diagnosis/physical_remarks.hpp"
#include "ecat/transport/link_speed.hpp"

namespace taktwerk::apps {

namespace {

using namespace std::chrono_literals;

constexpr Duration listening_time = 25ms;  // a master that is there sends at least every 10 ms
constexpr Duration refresh_period = 100ms;
constexpr Duration joining_glance = 10ms;

std::string outputs_text(const ecat::Survey& survey, const ecat::BusConfig& config) {
    std::string text;
    for (const auto& slave : config.slaves) {
        if (!slave.device || (slave.device->rx_pdos.empty() && !slave.device->mailbox)) continue;
        const auto at = std::find_if(survey.slaves.begin(), survey.slaves.end(), [&](const auto& one) { return one.name == slave.name; });
        const bool there = !slave.name.empty() && at != survey.slaves.end();
        text += (text.empty() ? "" : ", ") + (there            ? survey.subject(at->found.position)
                                              : slave.guest()  ? fmt::format("'{}' (once plugged in)", slave.name)
                                              : slave.position ? survey.subject(*slave.position)
                                                               : "'" + slave.name + "'");
    }
    return text;
}

}  // namespace

BusSession::BusSession(BusOptions options) : options_(std::move(options)) {}
BusSession::~BusSession() = default;

/// Opening needs several steps that can fail; the exit code says whose fault it was.
struct BusOpening {
    std::unique_ptr<BusSession> session;
    int code = exit_ok;

    static BusOpening open(const BusOptions& options) {
        BusOpening opening;
        opening.session.reset(new BusSession{options});
        opening.code = opening.fill();
        return opening;
    }

private:
    int fill() {
        auto& s = *session;
        const auto& options = s.options_;
        if (options.nic.empty() && options.machine.empty())
            return usage("say which bus: --nic INTERFACE, or --machine FILE (with --simulate for its simulated slaves)");
        if (options.simulate && (options.machine.empty() || !options.nic.empty()))
            return usage("--simulate plays the slaves of a machine file: give --machine FILE, and no --nic");
        std::optional<LoadedFile> loaded;
        if (!options.machine.empty()) {
            loaded = load_file(options.simulate);
            if (!loaded) return exit_bad_file;
            s.configured_ = loaded->machine.bus;
            // As the machine does (docs/bus.md): without real time nobody waits for the cycle to lock to the reference clock.
            if (loaded->machine.simulation.supervision == runtime::Supervision::relaxed) s.configured_.lock_required = false;
            s.machine_socket_ = loaded->hmi.socket;
        }
        const std::string nic = !options.nic.empty() ? options.nic : s.configured_.interface;
        if (nic.empty()) {
            s.clock_ = std::make_unique<VirtualClock>();
            s.where_ = fmt::format("simulated bus of '{}'", loaded->machine.name);
            s.world_ = std::make_unique<runtime::World>(loaded->machine, s.clock_->now());
        } else {
            s.where_ = nic;
            s.clock_ = std::make_unique<SystemClock>();
            // With --nic alone the bus is looked at as a line, from that interface.
            const bool as_ring = options.nic.empty() && s.configured_.ring;
            if (as_ring) s.where_ += " and " + s.configured_.ring->interface2;
            auto opened =
                ecat::BusInterfaces::open(nic, as_ring ? s.configured_.ring->interface2 : std::string{}, ring_patience(s.configured_),
                                          options.nic.empty() ? s.configured_.transport : ecat::BusTransport::packet);
            if (!opened) return fail(options, in_other_words(opened.error(), nic));
            s.nic_ = std::move(*opened);
        }
        if (!options.pcap.empty()) {
            auto capture =
                ecat::FrameCapture::create(options.pcap, {options.nic, {}, s.simulated() ? Duration{} : calendar_minus_machine_time()});
            if (!capture) return fail(options, capture.error());
            s.capture_ = std::move(*capture);
        }
        s.deadline_ = s.clock_->now();
        s.new_probe({});
        return exit_ok;
    }

    /// Two masters on one cable disturb each other; whose machine it is, and that it can be asked, the transport does not know.
    Error in_other_words(Error error, const std::string& nic) const {
        if (error.code != "transport.in_use") return error;
        if (const auto running = machine_on(nic, session->machine_socket_))
            return Error{"bus.machine_runs", nic,
                         fmt::format("machine '{}' runs on this interface (process {}); a second master would disturb it", running->name,
                                     running->process),
                         fmt::format("`taktwerk drive` can ask the machine itself: say -s {} instead of the bus; or end it first: taktwerk "
                                     "shutdown -s {}",
                                     running->socket, running->socket)};
        error.remedy += "; `taktwerk drive` can ask a running machine itself: say -s MACHINE instead of the bus";
        return error;
    }

    std::optional<LoadedFile> load_file(bool simulate) const {
        const auto& options = session->options_;
        config::LoadResult result = read_machine_without_programs(options.machine, simulate);
        if (const auto* errors = std::get_if<std::vector<Error>>(&result)) {
            if (options.json) fail(options, errors->front());
            else print_errors(*errors);
            return std::nullopt;
        }
        return std::move(std::get<LoadedFile>(result));
    }

    int usage(const char* what) const {
        fail(session->options_, Error{"usage", "", what, ""});
        return exit_usage;
    }
};

void BusSession::new_probe(ecat::BusConfig config) {
    probe_.reset();  // its scripts go before the transport gets another master
    probe_ = std::make_unique<ecat::BusProbe>(transport(), std::move(config), [this](Duration period) { return next_round(period); });
    if (capture_) probe_->master().set_tap(&ecat::FrameCapture::tap, capture_.get());
}

std::optional<Instant> BusSession::next_round(Duration period) {
    if (stop_requested() && !closing_) return std::nullopt;
    const Instant before = clock_->now();
    deadline_ += period;
    if (deadline_ < before) deadline_ += (before - deadline_ + period) / period * period;  // late: the next in the same phase
    clock_->sleep_until(deadline_);
    const Instant now = clock_->now();
    if (world_) world_->apply_events(now);
    if (nic_ && now >= next_refresh_) {
        nic_->refresh();
        next_refresh_ = now + refresh_period;
    }
    if (capture_)
        if (auto written = capture_->drain(); !written) print_warning(written.error());
    return now;
}

Result<ecat::Survey> BusSession::look() {
    if (nic_) {
        nic_->refresh();
        if (!nic_->bus().link_up())
            return Error{"bus.no_link", where_, "the network port has no link",
                         "check the cable and that the first slave has power; its IN port shows a light when it has"};
        if (!up_) {
            const Result<std::uint64_t> heard = probe_->listen(listening_time);
            if (!heard) return heard.error();
            foreign_frames_ = *heard;
            foreign_sender_ = foreign_frames_ > 0 ? ecat::sender_text(probe_->bus().link) : std::string{};
        }
    }
    const auto may = up_                   ? ecat::SurveyMay::as_brought_up
                     : foreign_frames_ > 0 ? ecat::SurveyMay::only_look
                                           : ecat::SurveyMay::give_addresses;
    Result<ecat::Survey> found =
        probe_->run(ecat::survey(probe_->port(), may, transport().ring() != nullptr ? &probe_->bus().link.ring : nullptr));
    if (!found) {
        Error error = found.error();
        if (error.code == "bus.no_frame")
            error = Error{
                "bus.no_frame", where_, "no frame came back: there is a link, but no EtherCAT slave at its other end",
                "check that the cable goes to the IN port of the first slave, and that it is an EtherCAT device with power; where the last "
                "slave's cable comes back to this computer, say --machine with a file that has `ring`"};
        return error;
    }
    const auto& slaves = configured_.slaves;
    if (std::any_of(slaves.begin(), slaves.end(), [](const ecat::SlaveConfig& slave) { return slave.device_id.has_value(); }))
        if (auto asked = probe_->run(ecat::read_device_ids(probe_->port(), *found)); !asked) return asked.error();
    ecat::compare_with(configured_, *found);
    if (auto broken = ecat::ring_remark(*found)) found->remarks.push_back(std::move(*broken));
    for (auto& overload : ecat::ebus_overloads(*found)) found->remarks.push_back(std::move(overload));
    if (nic_)
        if (auto speed = ecat::link_speed_trouble(nic_->first())) found->remarks.push_back(std::move(*speed));
    if (foreign_frames_ > 0)
        found->remarks.push_back(Error{"bus.foreign_master", where_,
                                       fmt::format("another master is sending on this cable ({} frames in {} ms): {}", foreign_frames_,
                                                   listening_time / 1ms, foreign_sender_),
                                       "end it before you change anything"});
    return found;
}

Result<void> BusSession::may_write(const ecat::Survey& survey, std::string_view doing) {
    if (up_ || options_.force) return {};
    if (foreign_frames_ > 0)
        return Error{"bus.foreign_master", where_,
                     fmt::format("another master is sending on this cable; {} would disturb it: {}", doing, foreign_sender_),
                     "end that master first; with --force it is done all the same"};
    if (survey.highest_state >= ecat::AlState::safeop)
        print_warning(Error{"bus.foreign_master", where_,
                            fmt::format("slaves are in {} although nobody is heard on this cable: another master may have left them so",
                                        ecat::name(survey.highest_state)),
                            "taktwerk bus state init takes them down"});
    return {};
}

Result<void> BusSession::must_be_alone(std::string_view doing) const {
    if (foreign_frames_ == 0) return {};
    return Error{"bus.foreign_master", where_,
                 fmt::format("another master is sending on this cable, and beside it nobody begins {}, with --force neither: {}", doing,
                             foreign_sender_),
                 "end that master first; the slaves were left as they are"};
}

void BusSession::adopt(const ecat::Survey& survey) {
    if (up_) return;
    new_probe(ecat::derived_config(survey, configured_));
    ecat::adopt(probe_->bus(), survey);
}

Result<void> BusSession::confirm_operation(const ecat::Survey& survey) {
    if (simulated() || options_.yes) return {};
    const std::string outputs = outputs_text(survey, configured_.slaves.empty() ? ecat::derived_config(survey) : configured_);
    if (::isatty(STDIN_FILENO) == 0)
        return Error{"bus.not_confirmed", where_, fmt::format("in OP outputs are driven (with 0) at: {}", outputs),
                     "see that nothing can move or switch, then say --yes"};
    fmt::print(stderr, "In OP outputs are driven (with 0) at: {}\nCan nothing move or switch that must not? [y/N] ", outputs);
    std::string answer;
    std::getline(std::cin, answer);
    if (answer == "y" || answer == "Y" || answer == "yes") return {};
    return Error{"bus.not_confirmed", where_, "the bus stays as it is", ""};
}

Result<void> BusSession::bring_up(const ecat::Survey& survey) {
    // Whoever is told --force may write beside it; but each master resets and addresses the slaves anew, and neither gets them to OP.
    if (!up_ && foreign_frames_ > 0)
        return Error{
            "bus.foreign_master", where_,
            fmt::format("another master is sending on this cable, and two masters never bring up one bus, with --force neither: {}",
                        foreign_sender_),
            "end that master first; the slaves were left as they are"};
    if (auto allowed = may_write(survey, "bringing the bus up"); !allowed) return allowed;
    if (auto confirmed = confirm_operation(survey); !confirmed) return confirmed;
    auto config = configured_.slaves.empty() ? ecat::derived_config(survey) : configured_;
    config.lock_required = configured_.lock_required;
    new_probe(std::move(config));
    up_ = true;
    auto done = probe_->bring_up();
    if (!done && done.error().code == "bus.foreign_master") up_ = false;  // it has touched nothing: close() must not take theirs down
    return done ? let_groups_join() : done;
}

/// Who is plugged in joins after the bus is in operation. Whoever looks at it wants to see it as it will be.
Result<void> BusSession::let_groups_join() {
    constexpr Duration longest = 10s;
    for (Duration waited{}; !bus().groups.empty() && !bus().groups_at_rest && waited < longest; waited += joining_glance)
        if (auto ran = probe_->run_for(joining_glance); !ran) return ran;
    return {};
}

Result<void> BusSession::close() {
    finish_undisturbed();
    if (up_) {
        up_ = false;
        if (auto down = probe_->take_down(); !down) return down;
    }
    if (!capture_) return {};
    if (capture_->dropped() > 0)
        print_warning(
            Error{"capture.dropped", options_.pcap, fmt::format("{} frames did not fit and are missing", capture_->dropped()), ""});
    return capture_->finish();
}

int exit_code_for(const Error& error) {
    for (const char* of_machine : {"command.", "socket.", "state.", "request."})
        if (error.code.rfind(of_machine, 0) == 0) return exit_code_of(error);
    for (const char* refused : {"drive.not_now", "drive.action", "drive.would_store", "drive.silent", "drive.refused"})
        if (error.code == refused) return exit_refused;
    if (error.code == "drive.not_taken" || error.code == "drive.cannot_store" || error.code == "drive.not_reset") return exit_refused;
    if (error.code.rfind("drive.", 0) == 0) return exit_usage;
    if (error.code == "bus.no_such_slave" || error.code == "sdo.value" || error.code == "bus.not_confirmed") return exit_usage;
    if (error.code == "sdo.abort" || error.code == "bus.refused_state") return exit_refused;
    for (const char* usage : {"usage.number", "bus.no_such_port", "eeprom.no_device", "esi.no_device", "esi.which_device", "foe.name"})
        if (error.code == usage) return exit_usage;
    for (const char* refused : {"foe.refused", "foe.not_offered", "foe.no_boot", "eoe.refused", "eoe.not_offered", "firmware.in_operation"})
        if (error.code == refused) return exit_refused;
    for (const char* of_file : {"capture.write", "eeprom.file", "eeprom.hex", "eeprom.exists", "foe.file", "foe.exists"})
        if (error.code == of_file) return exit_bad_file;
    if (error.code.rfind("esi.", 0) == 0) return exit_bad_file;
    if (error.code.rfind("eeprom.", 0) == 0) return exit_refused;
    return exit_bus;
}

int fail(const BusOptions& options, const Error& error) {
    if (options.json) print_json(Json{{"ok", false}, {"error", error_json(error)}});
    else print_error(error);
    return exit_code_for(error);
}

Json error_json(const Error& error) {
    return Json{{"code", error.code}, {"subject", error.subject}, {"what", error.what}, {"remedy", error.remedy}};
}

void print_json(const Json& json) { fmt::print("{}\n", json.dump(-1, ' ', false, Json::error_handler_t::replace)); }

int with_bus(const BusOptions& options, const std::function<int(BusSession&)>& work) {
    watch_stop_signals();
    BusOpening opening = BusOpening::open(options);
    if (opening.code != exit_ok) return opening.code;
    int code = work(*opening.session);
    std::fflush(stdout);
    if (auto closed = opening.session->close(); !closed) {
        print_error(closed.error());
        if (code == exit_ok) code = exit_code_for(closed.error());
    }
    return code;
}

Result<std::size_t> find_slave(const ecat::Survey& survey, const std::string& word) {
    for (std::size_t i = 0; i < survey.slaves.size(); ++i)
        if (!survey.slaves[i].name.empty() && survey.slaves[i].name == word) return i;
    std::size_t position = 0;
    const auto [end, problem] = std::from_chars(word.data(), word.data() + word.size(), position);
    if (problem == std::errc{} && end == word.data() + word.size() && position < survey.slaves.size()) return position;
    std::string names;
    for (const auto& slave : survey.slaves)
        if (!slave.name.empty()) names += (names.empty() ? " or " : ", ") + slave.name;
    return Error{"bus.no_such_slave", fmt::format("slave {}", word), "there is no such slave on the bus",
                 survey.slaves.size() == 1 ? "there is only slave 0" + names
                                           : fmt::format("choose a position from 0 to {}{}", survey.slaves.size() - 1, names)};
}

Result<ecat::BusSlave*> slave_at(BusSession& session, const ecat::Survey& survey, std::size_t position) {
    for (auto& slave : session.bus().slaves)
        if (slave->found.position == position ||
            (slave->config->guest() && !slave->away() && slave->config->name == survey.slaves.at(position).name))
            return slave.get();
    if (survey.slaves.at(position).found.error) return *survey.slaves[position].found.error;
    return Error{"bus.not_configured", survey.subject(position), "is not in the machine file, which brought the bus up",
                 "leave --operational away, or add it to the file"};
}

}  // namespace taktwerk::apps
