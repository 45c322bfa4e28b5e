#include "ecat/firmware/firmware_update.hpp"

#include <utility>

#include "ecat/firmware/boot_state.hpp"

namespace taktwerk::ecat {

namespace {

/// A slave that nobody touched starts what it had.
constexpr Duration untouched_patience = std::chrono::seconds{5};

void reach(FirmwareOutcome& outcome, FirmwareStage stage, const FirmwareSettings& settings) {
    outcome.reached = stage;
    if (settings.stage) settings.stage(stage);
}

/// Where it failed: an untouched slave goes back to INIT, another one stays where it takes the file again.
Script<void> leave_as_is(Bus& bus, BusSlave& slave, FirmwareOutcome& outcome, Error failure) {
    outcome.failure = std::move(failure);
    if (!outcome.begun) {
        const Result<void> back = co_await leave_boot(bus, slave, untouched_patience);
        (void)back;  // what state it is in is asked next
    }
    const Result<SlaveLeft> left = co_await look_at_left(bus, slave);
    if (left) outcome.left = *left;
}

/// INIT, its restart, who it is now.
Script<Result<void>> come_back(Bus& bus, BusSlave& slave, FirmwareOutcome& outcome, const FirmwareSettings& settings) {
    reach(outcome, FirmwareStage::leaving_boot, settings);
    const Result<void> back = co_await leave_boot(bus, slave, settings.restart_patience);
    if (!back) co_return back;
    reach(outcome, FirmwareStage::comparing, settings);
    const Result<DeviceVersion> after = co_await read_version(bus, slave);
    if (!after) co_return after.error();
    outcome.after = *after;
    if (after->silence) co_return *after->silence;
    co_return Result<void>{};
}

}  // namespace

Script<Result<FirmwareOutcome>> update_firmware(Bus& bus, BusSlave& slave, FoeFile file, std::vector<std::byte> content,
                                                FirmwareSettings settings) {
    FirmwareOutcome outcome;
    reach(outcome, FirmwareStage::looking, settings);
    const Result<DeviceVersion> before = co_await read_version(bus, slave);
    if (!before) {
        co_await leave_as_is(bus, slave, outcome, before.error());
        co_return outcome;
    }
    outcome.before = *before;
    reach(outcome, FirmwareStage::entering_boot, settings);
    const Result<void> booted = co_await enter_boot(bus, slave);
    if (!booted) {
        co_await leave_as_is(bus, slave, outcome, booted.error());
        co_return outcome;
    }
    reach(outcome, FirmwareStage::writing, settings);
    const Result<FoeWritten> written = co_await write_file(bus.port, slave.mailbox, std::move(file), std::move(content), settings.foe);
    if (!written) {
        co_await leave_as_is(bus, slave, outcome, written.error());
        co_return outcome;
    }
    outcome.begun = written->begun;
    outcome.acknowledged = written->acknowledged;
    if (written->failure) {
        co_await leave_as_is(bus, slave, outcome, *written->failure);
        co_return outcome;
    }
    const Result<void> back = co_await come_back(bus, slave, outcome, settings);
    if (!back) {
        co_await leave_as_is(bus, slave, outcome, back.error());
        co_return outcome;
    }
    reach(outcome, FirmwareStage::done, settings);
    const Result<SlaveLeft> left = co_await look_at_left(bus, slave);
    if (left) outcome.left = *left;
    co_return outcome;
}

}  // namespace taktwerk::ecat
