// `taktwerk bus` as a user meets it, on the simulated slaves of the demo machine: texts, JSON, and every way to go wrong.

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <filesystem>
#include <sstream>

#include "apps/bus/bus.hpp"
#include "apps/terminal/exit_code.hpp"
#include "apps/terminal/terminal_text.hpp"
#include "tests/apps/in_process.hpp"
#include "tests/apps/machine_files.hpp"

namespace taktwerk::apps {
namespace {

using ::testing::AllOf;
using ::testing::HasSubstr;
using ::testing::IsEmpty;
using ::testing::Not;
using ::testing::StartsWith;

/// On the simulated demo: SV33-E 'x_drive' and 'y_drive', SE-808X 'z_drive', terminal 'io'.
Outcome bus_on_demo(std::vector<std::string> words) {
    words.insert(words.begin(), "bus");
    words.insert(words.end(), {"--machine", demo, "--simulate"});
    return in_process(std::move(words));
}

std::size_t widest_line(const std::string& text) {
    std::size_t widest = 0;
    std::istringstream lines{text};
    for (std::string line; std::getline(lines, line);) widest = std::max(widest, columns(line));
    return widest;
}

TEST(BusCommand, ScanShowsEverySlaveWithIdentityAndNameWithinEightyColumns) {
    const auto scan = bus_on_demo({"scan"});
    EXPECT_EQ(scan.code, exit_ok) << scan.err;
    EXPECT_THAT(scan.out, AllOf(HasSubstr("4 slaves"), HasSubstr("'x_drive' sv33-e"), HasSubstr("'io'"), HasSubstr("INIT")));
    EXPECT_THAT(scan.out, HasSubstr("vendor 000007FBh product 000C0108h"));  // SV33-E manual
    EXPECT_THAT(scan.out, HasSubstr("to slave 1 'y_drive'"));
    EXPECT_THAT(scan.out, Not(HasSubstr("\033["))) << "no colour without a terminal";
    EXPECT_LE(widest_line(scan.out), 80u);
}

TEST(BusCommand, ScanAsJsonHoldsTheSame) {
    const auto scan = bus_on_demo({"scan", "--json"});
    ASSERT_EQ(scan.code, exit_ok) << scan.err;
    const Json json = scan.json();
    ASSERT_EQ(json["slaves"].size(), 4u);
    EXPECT_EQ(json["slaves"][0]["vendor"], 0x7FB);
    EXPECT_EQ(json["slaves"][1]["name"], "y_drive");
    EXPECT_EQ(json["slaves"][1]["parent"], 0);
    EXPECT_EQ(json["slaves"][3]["ports"].size(), 4u);
    EXPECT_TRUE(json["remarks"].empty());
}

TEST(BusCommand, StateShowsOpWhileTheMachineHoldsIt) {
    const auto low = bus_on_demo({"state"});
    EXPECT_EQ(low.code, exit_ok);
    EXPECT_THAT(low.out, AllOf(HasSubstr("slave 2 'z_drive'"), HasSubstr("INIT")));
    const auto preop = bus_on_demo({"state", "preop", "--slave", "y_drive", "--json"});
    ASSERT_EQ(preop.code, exit_ok) << preop.err;
    EXPECT_EQ(preop.json()["slaves"][1]["state"], "PREOP");
    EXPECT_EQ(preop.json()["slaves"][0]["state"], "INIT");
    const auto op = bus_on_demo({"state", "op", "--for", "100ms", "--json"});
    ASSERT_EQ(op.code, exit_ok) << op.err;
    for (const auto& slave : op.json()["slaves"]) EXPECT_EQ(slave["state"], "OP");
}

TEST(BusCommand, PdoShowsEntriesWithOffsetsAndInOpTheirValues) {
    const auto pdo = bus_on_demo({"pdo", "x_drive", "--operational"});
    ASSERT_EQ(pdo.code, exit_ok) << pdo.err;
    EXPECT_THAT(pdo.out, AllOf(StartsWith("slave 0 'x_drive'"), HasSubstr("SM2 outputs"), HasSubstr("6040h:00"), HasSubstr("6064h:00"),
                               HasSubstr("FMMU0")));
    EXPECT_LE(widest_line(pdo.out), 96u) << "with values it may be wider than a small terminal, but not by much";
    const auto json = bus_on_demo({"pdo", "3", "--json"}).json();
    ASSERT_EQ(json["slaves"].size(), 1u);
    EXPECT_EQ(json["slaves"][0]["position"], 3);
    EXPECT_FALSE(json["slaves"][0]["sync_managers"].empty());
}

TEST(BusCommand, SdoReadsByNameAndPositionAndSaysTheType) {
    const auto read = bus_on_demo({"sdo", "read", "x_drive", "1018h:01"});
    ASSERT_EQ(read.code, exit_ok) << read.err;
    EXPECT_THAT(read.out, HasSubstr("2043 (000007FBh)"));
    const auto json = bus_on_demo({"sdo", "read", "0", "6085", "--json"}).json();
    EXPECT_EQ(json["index"], 0x6085);
    EXPECT_EQ(json["type"], "U32");
    EXPECT_EQ(json["bytes"].get<std::string>().size(), 8u);
}

TEST(BusCommand, SdoWritesAndReadsBack) {
    const auto written = bus_on_demo({"sdo", "write", "x_drive", "6085h", "500000"});
    ASSERT_EQ(written.code, exit_ok) << written.err;
    EXPECT_THAT(written.out, AllOf(HasSubstr("6085h:00"), HasSubstr("reads back 500000")));
}

TEST(BusCommand, AnSdoThatTheSlaveRefusesIsARefusalWithTheAbortText) {
    const auto missing = bus_on_demo({"sdo", "read", "x_drive", "2FFFh", "--type", "U16"});
    EXPECT_EQ(missing.code, exit_refused);
    EXPECT_THAT(missing.err, AllOf(HasSubstr("2FFFh"), HasSubstr("06020000h")));
    const auto read_only = bus_on_demo({"sdo", "write", "x_drive", "6041h", "1", "--json"});
    EXPECT_EQ(read_only.code, exit_refused);
    EXPECT_EQ(read_only.json()["ok"], false);
    EXPECT_EQ(read_only.json()["error"]["code"], "sdo.abort");
}

TEST(BusCommand, WrongWordsAreUsageErrors) {
    EXPECT_EQ(bus_on_demo({"sdo", "read", "9", "6041h"}).code, exit_usage);
    EXPECT_THAT(bus_on_demo({"sdo", "read", "w_drive", "6041h"}).err, AllOf(HasSubstr("0 to 3"), HasSubstr("z_drive")));
    EXPECT_EQ(bus_on_demo({"sdo", "read", "0", "statusword"}).code, exit_usage);
    EXPECT_EQ(bus_on_demo({"sdo", "read", "0", "6041h", "--type", "word"}).code, exit_usage);
    EXPECT_EQ(bus_on_demo({"sdo", "write", "0", "6040h", "70000"}).code, exit_usage);
    EXPECT_EQ(bus_on_demo({"state", "fly"}).code, exit_usage);
    EXPECT_EQ(in_process({"bus"}).code, exit_usage);
    const auto nowhere = in_process({"bus", "scan"});
    EXPECT_EQ(nowhere.code, exit_usage);
    EXPECT_THAT(nowhere.err, HasSubstr("--nic"));
    EXPECT_EQ(in_process({"bus", "scan", "--simulate", "--nic", "eth1"}).code, exit_usage);
}

TEST(BusCommand, AMissingInterfaceOrFileIsNamed) {
    const auto nic = in_process({"bus", "scan", "--nic", "nonic7"});
    EXPECT_EQ(nic.code, exit_bus);
    EXPECT_THAT(nic.err, HasSubstr("nonic7"));
    const auto json = in_process({"bus", "scan", "--nic", "nonic7", "--json"});
    EXPECT_EQ(json.code, exit_bus);
    EXPECT_EQ(json.json()["error"]["code"], "transport.no_such_interface");
    EXPECT_EQ(in_process({"bus", "why", "--machine", "/nowhere.yaml"}).code, exit_bad_file);
    EXPECT_EQ(bus_on_demo({"scan", "--pcap", "/nowhere/bus.pcap"}).code, exit_bad_file);
}

TEST(BusCommand, SdoDumpListsTheDictionary) {
    const auto dump = bus_on_demo({"sdo", "dump", "x_drive"});
    ASSERT_EQ(dump.code, exit_ok) << dump.err;
    EXPECT_THAT(dump.out, AllOf(HasSubstr("6041h"), HasSubstr("1018h"), HasSubstr("access: read and write in PREOP, SAFEOP, OP")));
    const auto json = bus_on_demo({"sdo", "dump", "x_drive", "--json"}).json();
    EXPECT_GT(json["objects"].size(), 20u);
}

TEST(BusCommand, DcShowsTheReferenceAndSync0InOp) {
    const auto free = bus_on_demo({"dc"});
    EXPECT_EQ(free.code, exit_ok);
    EXPECT_THAT(free.out, HasSubstr("run free"));
    const auto op = bus_on_demo({"dc", "--operational"});
    ASSERT_EQ(op.code, exit_ok) << op.err;
    EXPECT_THAT(op.out, AllOf(HasSubstr("reference"), HasSubstr("1000 us")));
    EXPECT_LE(widest_line(op.out), 80u);
}

TEST(BusCommand, CountersSayWhenAllIsWell) {
    const auto counters = bus_on_demo({"counters"});
    EXPECT_EQ(counters.code, exit_ok) << counters.err;
    EXPECT_THAT(counters.out, HasSubstr("No port has counted an error"));
    EXPECT_LE(widest_line(counters.out), 80u);
    EXPECT_EQ(bus_on_demo({"counters", "--watch", "--for", "3s", "--reset"}).code, exit_ok);
    EXPECT_TRUE(bus_on_demo({"counters", "--json"}).json()["findings"].empty());
}

TEST(BusCommand, WhySaysWhenThereIsNothingToExplain) {
    const auto why = bus_on_demo({"why"});
    EXPECT_EQ(why.code, exit_ok) << why.out << why.err;
    EXPECT_THAT(why.out, HasSubstr("reaches OP with 4 slaves"));
    EXPECT_EQ(bus_on_demo({"why", "--json"}).json()["operational"], true);
}

// One page about the slave in the way, with the facts a technician asks for.
TEST(BusText, WhyNamesStateCodeSizesCauseAndRemedy) {
    ecat::WhyReport report;
    report.failure = Error{"bus.refused_state", "slave 1 'y' (sv33-e)", "refused SAFEOP", ""};
    ecat::WhySlave bad, good;
    bad.subject = "slave 1 'y' (sv33-e)";
    bad.failed = bad.al_error = true;
    bad.state = ecat::AlState::preop;
    bad.al_code = 0x001D;  // ETG.1000.6: invalid output configuration
    ecat::Refusal facts;
    facts.asked = ecat::AlState::safeop;
    facts.reached = ecat::AlState::preop;
    facts.sync_managers.push_back({2, ecat::SyncManager{0x1800, 19, 0x64, 0, 1, 0}, ecat::SyncManager{0x1800, 19, 0x64, 0, 1, 0}, 12, {}});
    bad.facts = facts;
    bad.cause = "SM2 is 19 bytes, the PDOs that the slave reports need 12";
    bad.remedy = "the slave kept another assignment";
    good.subject = "slave 0 'x' (sv33-e)";
    good.state = ecat::AlState::preop;
    report.slaves = {good, bad};

    const std::string text = why_text("eth1", report, Colours::off);

    EXPECT_THAT(text, AllOf(HasSubstr("eth1: the bus does not reach OP"), HasSubstr("SAFEOP, is in PREOP and shows an error"),
                            HasSubstr("code 001Dh"), HasSubstr("SM2 is 19 bytes at 1800h, the slave maps 12"),
                            HasSubstr("cause       SM2 is 19 bytes"), HasSubstr("remedy      the slave kept"),
                            HasSubstr("Waiting for it: slave 0 'x'")));
    EXPECT_LE(widest_line(text), 80u);
    const Json json = why_json(report);
    EXPECT_EQ(json["slaves"][1]["facts"]["sync_managers"][0]["mapped_bytes"], 12);
    EXPECT_EQ(Json::parse(json.dump())["failure"]["code"], "bus.refused_state");
}

// A coupler with a branch at port 3 and a line behind port 1; the frame takes the branch first.
TEST(BusText, ScanDrawsBranchesAndTheEbusBudget) {
    ecat::Survey survey;
    const auto open = [](std::initializer_list<unsigned> ports) {
        std::uint16_t status = 0x5500;
        for (const unsigned p : ports) status = static_cast<std::uint16_t>((status & ~(1u << (8 + 2 * p))) | (1u << (9 + 2 * p)));
        return status;
    };
    const std::vector<std::uint16_t> links{open({0, 1, 3}), open({0, 1}), open({0}), open({0})};
    for (std::size_t i = 0; i < links.size(); ++i) {
        ecat::SurveyedSlave slave;
        slave.found.position = static_cast<std::uint16_t>(i);
        slave.found.station = static_cast<std::uint16_t>(0x1001 + i);
        slave.device_name = std::string{"device "} + static_cast<char>('A' + i);
        slave.state = ecat::AlState::preop;
        for (unsigned p = 0; p < 4; ++p) slave.ports[p].open = slave.ports[p].link = ecat::dl_port_open(links[i], p);
        survey.slaves.push_back(slave);
    }
    survey.slaves[0].ebus_current = -2000;
    survey.slaves[0].ebus_left = 2000;
    auto tree = ecat::build_topology(links);
    ASSERT_TRUE(tree);
    survey.topology = *tree;

    const std::string text = scan_text("eth1", survey, Colours::off);

    EXPECT_THAT(text, HasSubstr("├3─1  device B"));
    EXPECT_THAT(text, HasSubstr("│  2  device C")) << text;
    EXPECT_THAT(text, HasSubstr("\n3  device D"));
    EXPECT_THAT(text, HasSubstr("E-bus: supplies 2000 mA, 2000 mA left"));
    EXPECT_THAT(text, HasSubstr("port 0 from the master, 1 to slave 3, 3 to slave 1"));
}

// first interface - A - B - second interface; then the cable between them is out.
TEST(BusText, ScanShowsARingAndWhereItIsBroken) {
    ecat::Survey survey;
    survey.slaves.resize(2);
    for (std::size_t i = 0; i < 2; ++i) {
        survey.slaves[i].found.position = static_cast<std::uint16_t>(i);
        survey.slaves[i].ports[0] = survey.slaves[i].ports[1] = {.kind = ecat::PortKind::mii, .link = true, .open = true, .counters = {}};
    }
    constexpr std::uint16_t both_open = 0x5A30;
    survey.topology = ecat::build_ring_topology(std::vector{both_open, both_open}, 2).value();
    survey.ring = {ecat::RingShape::closed, 2, 0, 0};
    EXPECT_THAT(scan_text("eth1 and eth2", survey, Colours::off), HasSubstr("2 slaves, a closed ring"));
    EXPECT_THAT(scan_text("eth1 and eth2", survey, Colours::off), HasSubstr("1 MII to the second interface"));
    EXPECT_FALSE(ecat::ring_remark(survey));
    survey.ring = {ecat::RingShape::open, 1, 1, 1};
    ASSERT_TRUE(ecat::ring_remark(survey));
    EXPECT_THAT(ecat::ring_remark(survey)->what, HasSubstr("between slave 0 and slave 1"));
    EXPECT_THAT(scan_text("eth1 and eth2", survey, Colours::off), HasSubstr("a broken ring"));
}

TEST(BusText, ScanKeepsThePositionApartFromTheNameHoweverLongTheBusIs) {
    ecat::Survey survey;
    survey.slaves.resize(101);
    for (auto& slave : survey.slaves) slave.device_name = "terminal";
    const std::string text = scan_text("eth1", survey, Colours::off);
    for (const char* head : {"\n0  terminal", "\n99 terminal", "\n100 terminal"}) EXPECT_THAT(text, HasSubstr(head));
}

TEST(TextTable, AlignsColumnsCutsLongCellsAndLeavesNoTrailingSpace) {
    TextTable table{{{"name", TextTable::Column::Side::left, 6}, {"n", TextTable::Column::Side::right}, {"x"}}};
    table.add({"abcdefgh", "5", ""});
    table.add({"轴", "123"});
    EXPECT_EQ(table.text(Colours::off), "name      n  x\nabcde…    5\n轴      123\n");
    EXPECT_THAT(table.text(Colours::on), HasSubstr("\033[2mname\033[0m"));
}

TEST(TextTable, WrapsBetweenWords) { EXPECT_EQ(wrapped("one two three four", 2, 10), "one two\n  three\n  four"); }

}  // namespace
}  // namespace taktwerk::apps
