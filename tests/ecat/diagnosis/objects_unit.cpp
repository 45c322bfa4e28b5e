// Mailbox, process data and the reasons for a refusal, asked from the side of a bus of simulated slaves.

#include <gmock/gmock.h>

#include "ecat/bringup/scan.hpp"
#include "ecat/diagnosis/mailbox_access.hpp"
#include "ecat/diagnosis/pdo_report.hpp"
#include "ecat/diagnosis/why_not_op.hpp"
#include "tests/ecat/diagnosis/probed_bus.hpp"

namespace taktwerk::ecat {
namespace {

using namespace std::chrono_literals;
using test::ProbedBus;
using testing::HasSubstr;
using testing::SizeIs;

Script<Result<std::vector<std::byte>>> open_and_read(Bus& bus, BusSlave& slave, std::uint16_t index, std::uint8_t sub) {
    const Result<void> open = co_await open_mailbox(bus, slave);
    if (!open) co_return open.error();
    co_return co_await read_object(bus, slave, index, sub);
}

Script<Result<PdoReport>> open_and_report(Bus& bus, BusSlave& slave) {
    if (slave.has_coe()) {
        const Result<void> open = co_await open_mailbox(bus, slave);
        if (!open) co_return open.error();
    }
    co_return co_await read_pdos(bus, slave);
}

TEST(MailboxAccess, ASlaveInInitIsTakenToPreopAndRead) {
    ProbedBus bus{"s"};
    const Survey found = bus.look();
    auto probing = bus.probe(derived_config(found, bus.config));
    adopt(probing.bus(), found);

    const auto value = probing.run(open_and_read(probing.bus(), *probing.bus().slaves[0], 0x6085, 0));

    ASSERT_TRUE(value) << value.error().text();
    EXPECT_THAT(*value, SizeIs(4));
    EXPECT_EQ(load_le<std::uint32_t>(*value), 100u) << "the default of the description";
    EXPECT_EQ(bus.state(0), sim::EsmState::preop);
}

TEST(MailboxAccess, InOpTheMailboxIsUsedAsItWasSetUp) {
    ProbedBus bus{"s"};
    ASSERT_TRUE(bus.bring_up()) << bus.why();
    const Survey found = bus.look();
    auto probing = bus.probe(derived_config(found, bus.config));
    adopt(probing.bus(), found);

    const auto value = probing.run(open_and_read(probing.bus(), *probing.bus().slaves[0], 0x1018, 1));

    ASSERT_TRUE(value) << value.error().text();
    EXPECT_EQ(load_le<std::uint32_t>(*value), 0x7FBu);
}

TEST(MailboxAccess, ATerminalHasNoObjects) {
    ProbedBus bus{"t"};
    const Survey found = bus.look();
    auto probing = bus.probe(derived_config(found, bus.config));
    adopt(probing.bus(), found);
    const auto value = probing.run(open_and_read(probing.bus(), *probing.bus().slaves[0], 0x1018, 1));
    ASSERT_FALSE(value);
    EXPECT_EQ(value.error().code, "sdo.no_mailbox");
}

// The factory assignment of the servo is 1701h: 6040h (16 bits) at 0, 607Ah (32 bits) behind it: 6 bytes in SM2.
TEST(PdoReport, ShowsWhatTheSlaveHasAssignedWithOffsetsAndNames) {
    ProbedBus bus{"s"};
    Survey found = bus.look();
    compare_with(bus.config, found);
    auto probing = bus.probe(derived_config(found, bus.config));
    adopt(probing.bus(), found);

    const auto report = probing.run(open_and_report(probing.bus(), *probing.bus().slaves[0]));

    ASSERT_TRUE(report) << report.error().text();
    EXPECT_FALSE(report->error);
    const auto outputs = std::find_if(report->sync_managers.begin(), report->sync_managers.end(),
                                      [](const SyncManagerReport& sm) { return sm.use == SmUse::outputs; });
    ASSERT_NE(outputs, report->sync_managers.end());
    EXPECT_EQ(outputs->number, 2);
    EXPECT_EQ(outputs->mapped_bytes, 6u);
    ASSERT_THAT(outputs->pdos, SizeIs(1));
    EXPECT_EQ(outputs->pdos[0].index, 0x1701);
    ASSERT_THAT(outputs->pdos[0].entries, SizeIs(2));
    EXPECT_EQ(outputs->pdos[0].entries[1].index, 0x607A);
    EXPECT_EQ(outputs->pdos[0].entries[1].bit_offset, 16u);
    EXPECT_FALSE(outputs->pdos[0].entries[1].value) << "there is no process data in PREOP";
}

TEST(PdoReport, InOpEntriesHaveTheirPresentValues) {
    ProbedBus bus{"st"};
    ASSERT_TRUE(bus.bring_up()) << bus.why();
    const auto target = bus.master->output(0, 0x607A, 0);
    ASSERT_TRUE(target);
    store_le<std::int32_t>(bus.master->outputs(), target->bit_offset / 8, 123456);
    bus.run_for(20ms);
    Survey found = bus.look();
    compare_with(bus.config, found);
    auto probing = bus.probe(derived_config(found, bus.config));
    adopt(probing.bus(), found);

    const auto report = probing.run(open_and_report(probing.bus(), *probing.bus().slaves[0]));

    ASSERT_TRUE(report) << report.error().text();
    for (const auto& sm : report->sync_managers)
        for (const auto& pdo : sm.pdos)
            for (const auto& entry : pdo.entries)
                if (entry.index == 0x607A || entry.index == 0x6064) {  // the servo echoes its target
                    ASSERT_TRUE(entry.value) << entry.name;
                    EXPECT_EQ(load_le<std::int32_t>(*entry.value), 123456) << entry.name;
                }
    // Outputs and inputs each have a FMMU to their sync manager; a further one may bring the mailbox' status along.
    const auto mapped = [&](std::uint16_t physical) {
        return std::count_if(report->fmmus.begin(), report->fmmus.end(),
                             [&](const auto& f) { return f.second.physical_start == physical; });
    };
    EXPECT_EQ(mapped(0x1800), 1);
    EXPECT_EQ(mapped(0x1C00), 1);
}

TEST(WhyNotOp, TheSlaveThatRefusesIsExplainedAndTheOthersWait) {
    // 001Dh: invalid output configuration (ETG.1000.6).
    ProbedBus bus{"sst"};
    bus.network.slave(1).refuse_state(sim::EsmState::safeop, 0x001D);
    auto probing = bus.probe(bus.config);
    const auto up = probing.bring_up();
    ASSERT_FALSE(up);

    const auto report = probing.run(explain(probing.bus(), up.error()));

    ASSERT_TRUE(report);
    EXPECT_EQ(report->failure.code, "bus.refused_state");
    ASSERT_THAT(report->slaves, SizeIs(3));
    EXPECT_FALSE(report->slaves[0].failed);
    EXPECT_FALSE(report->slaves[2].failed);
    const auto& bad = report->slaves[1];
    EXPECT_TRUE(bad.failed);
    EXPECT_EQ(bad.al_code, 0x001D);
    EXPECT_EQ(bad.state, AlState::preop);
    ASSERT_TRUE(bad.facts);
    EXPECT_EQ(bad.facts->asked, AlState::safeop);
    EXPECT_FALSE(bad.cause.empty());
    EXPECT_FALSE(bad.remedy.empty());
}

TEST(WhyNotOp, AnSdoThatWasRefusedIsTheCause) {
    ProbedBus bus{"s"};
    bus.config.slaves[0].startup.push_back({.index = 0x2FFF, .sub = 0, .type = DataType::U16, .value = 1, .origin = "test.yaml:7:3"});
    auto probing = bus.probe(bus.config);
    const auto up = probing.bring_up();
    ASSERT_FALSE(up);

    const auto report = probing.run(explain(probing.bus(), up.error()));

    ASSERT_TRUE(report);
    ASSERT_THAT(report->slaves, SizeIs(1));
    EXPECT_TRUE(report->slaves[0].failed);
    EXPECT_THAT(report->slaves[0].cause, HasSubstr("2FFFh"));
    EXPECT_THAT(report->slaves[0].cause, HasSubstr("06020000h"));  // object does not exist
}

TEST(WhyNotOp, WhenTheScanItselfFailsThereIsNobodyToExamine) {
    ProbedBus bus{"s"};
    bus.network.set_power(0, false);
    auto probing = bus.probe(bus.config);
    const auto up = probing.bring_up();
    ASSERT_FALSE(up);
    const auto report = probing.run(explain(probing.bus(), up.error()));
    ASSERT_TRUE(report);
    EXPECT_THAT(report->slaves, SizeIs(0));
    EXPECT_FALSE(report->failure.what.empty());
}

}  // namespace
}  // namespace taktwerk::ecat
