#include "apps/drive/over_bus.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include "apps/drive/over_line.hpp"
#include "apps/drive/profiles.hpp"
#include "axes/drives/cia402/cia402_drive.hpp"
#include "ecat/diagnosis/mailbox_access.hpp"

namespace taktwerk::apps {

namespace {

using namespace std::chrono_literals;

constexpr axes::ParameterAddress error_code{0x603F, 0};
constexpr axes::ParameterAddress store_object{0x1010, 1};  // CiA 301
constexpr std::int64_t signature_save = 0x65766173;        // "save", CiA 301 1010h
constexpr Duration after_storing = 5s;                     // longest stated: XP200 9.3, 5 s

ecat::Script<Result<std::vector<std::byte>>> upload(ecat::Bus& bus, ecat::BusSlave& slave, std::uint16_t index, std::uint8_t sub) {
    if (slave.mailbox.station == 0) {
        const Result<void> opened = co_await ecat::open_mailbox(bus, slave);
        if (!opened) co_return opened.error();
    }
    co_return co_await ecat::read_object(bus, slave, index, sub);
}

ecat::Script<Result<void>> download(ecat::Bus& bus, ecat::BusSlave& slave, std::uint16_t index, std::uint8_t sub,
                                    std::vector<std::byte> value) {
    if (slave.mailbox.station == 0) {
        const Result<void> opened = co_await ecat::open_mailbox(bus, slave);
        if (!opened) co_return opened.error();
    }
    co_return co_await ecat::write_object(bus, slave, index, sub, std::move(value));
}

std::uint64_t number(const std::vector<std::byte>& bytes) {
    std::uint64_t out = 0;
    for (std::size_t i = 0; i < bytes.size() && i < 8; ++i) out |= std::to_integer<std::uint64_t>(bytes[i]) << (8 * i);
    return out;
}

class DriveOverBus final : public DriveAccess {
public:
    DriveOverBus(BusSession& session, const ecat::Survey& survey, ecat::BusSlave& slave, std::shared_ptr<const axes::DriveProfile> profile,
                 int axis)
        : DriveAccess(std::move(profile)), session_(session), survey_(survey), slave_(&slave), axis_(axis) {}

    [[nodiscard]] std::string subject() const override {
        return profile().axes > 1 ? fmt::format("{}, axis {} of {}", slave_->subject, axis_, profile().axes) : slave_->subject;
    }
    [[nodiscard]] std::string word() const override {
        const auto& name = survey_.slaves.at(slave_->found.position).name;
        const auto drive = name.empty() ? std::to_string(slave_->found.position) : name;
        return profile().axes > 1 ? fmt::format("{} --axis {}", drive, axis_) : drive;
    }
    [[nodiscard]] std::string where() const override { return session_.where(); }

    [[nodiscard]] Result<std::vector<std::byte>> read_bytes(const axes::DriveParameter& parameter) override {
        return read_object(parameter.address);
    }
    [[nodiscard]] Result<void> write_bytes(const axes::DriveParameter& parameter, std::vector<std::byte> value, Storing) override {
        return session_.probe().run(
            download(session_.bus(), *slave_, index_of(parameter.address), parameter.address.sub, std::move(value)));
    }
    [[nodiscard]] Result<void> store_all() override;
    [[nodiscard]] Result<DriveComplaint> complaint() override;
    [[nodiscard]] Result<bool> reset_fault(Duration patience) override;
    void wait(Duration time) override { (void)session_.probe().run_for(time); }  // interrupted: the next access says so
    void finish_undisturbed() override { session_.finish_undisturbed(); }

private:
    [[nodiscard]] std::uint16_t index_of(const axes::ParameterAddress& address) const noexcept {
        const bool per_axis = address.index >= 0x2000;
        return static_cast<std::uint16_t>(address.index + (per_axis ? (axis_ - 1) * profile().object_offset : 0));
    }
    [[nodiscard]] Result<std::vector<std::byte>> read_object(const axes::ParameterAddress& address) {
        return session_.probe().run(upload(session_.bus(), *slave_, index_of(address), address.sub));
    }

    BusSession& session_;
    const ecat::Survey& survey_;
    ecat::BusSlave* slave_;
    int axis_;
};

Result<void> DriveOverBus::store_all() {
    for (const auto& parameter : profile().parameters) {
        if (parameter.address != store_object) continue;
        if (auto done = write(parameter, signature_save, Storing::asked); !done) return done;
        wait(after_storing);
        return {};
    }
    return Error{"drive.cannot_store", subject(), "has no object 1010h:01 to store by", "leave --store away"};
}

Result<DriveComplaint> DriveOverBus::complaint() {
    const auto code = read_object(error_code);
    if (!code) return code.error();
    DriveComplaint out;
    out.code = static_cast<std::uint16_t>(number(*code));
    if (out.code != 0 && profile().alarm_detail_index != 0)
        if (const auto detail = read_object({profile().alarm_detail_index, profile().alarm_detail_sub}))
            out.detail = static_cast<std::uint32_t>(number(*detail));
    return out;
}

/// Brings the bus up as the machine file has it and asks by the control word: disabled, targets at rest.
Result<bool> DriveOverBus::reset_fault(Duration patience) {
    const auto& configured = session_.configured();
    const auto position = slave_->found.position;
    if (configured.slaves.empty())
        return Error{"drive.not_reset", subject(), "a reset needs process data, and no machine file says which", "give --machine FILE"};
    if (auto up = session_.bring_up(survey_); !up) return up.error();
    const auto slave = slave_at(session_, survey_, position);
    if (!slave) return slave.error();
    slave_ = *slave;
    const Duration cycle = configured.cycle;
    axes::cia402::Cia402Drive port(session_.probe().master(), slave_->index, static_cast<std::uint8_t>(axis_ - 1), shared_profile(), cycle);
    if (auto resolved = port.resolve(); !resolved) return resolved.error();
    axes::DriveCommand command;  // power off, at rest
    const auto round = [&](bool reset) -> Result<axes::DriveFeedback> {
        if (auto ran = session_.probe().run_for(cycle); !ran) return ran.error();
        const auto feedback = port.decode(session_.now());
        command.position = feedback.position;
        command.reset_fault = reset;
        port.encode(command, session_.now());
        return feedback;
    };
    for (Duration spent{}; spent < patience; spent += cycle) {
        const auto feedback = round(true);
        if (!feedback) return feedback.error();
        if (feedback->online && feedback->power != axes::PowerState::unknown && !feedback->fault) {
            for (int i = 0; i < 10; ++i) (void)round(false);  // bit 7 back to 0
            return true;
        }
    }
    (void)round(false);
    return false;
}

}  // namespace

int with_drive_over_bus(const DriveOptions& options, const std::function<int(DriveAccess&)>& work) {
    return with_bus(*options.bus, [&](BusSession& session) {
        const auto refuse = [&](const Error& error) { return fail(*options.bus, error); };
        const Result<ecat::Survey> found = session.look();
        if (!found) return refuse(found.error());
        const Result<std::size_t> position = find_slave(*found, options.drive);
        if (!position) {
            auto error = position.error();
            if (const auto others = drives_on_lines(options); !others.empty())
                error.remedy += fmt::format("; on serial lines there is: {}", fmt::join(others, ", "));
            return refuse(error);
        }
        const auto profile = profile_of_slave(options, *found, *position);
        if (!profile) return refuse(profile.error());
        if (options.axis > (*profile)->axes)
            return refuse({"drive.no_axis", found->subject(*position),
                           fmt::format("{} has {}", (*profile)->name,
                                       (*profile)->axes == 1 ? std::string("1 axis") : fmt::format("{} axes", (*profile)->axes)),
                           "leave --axis away, or choose one it has"});
        if (auto allowed = session.may_write(*found, "speaking to its mailboxes"); !allowed) return refuse(allowed.error());
        session.adopt(*found);
        const Result<ecat::BusSlave*> slave = slave_at(session, *found, *position);
        if (!slave) return refuse(slave.error());
        DriveOverBus access(session, *found, **slave, *profile, options.axis);
        return work(access);
    });
}

}  // namespace taktwerk::apps
