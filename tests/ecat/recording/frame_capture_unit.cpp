// The file as bytes, and what another make of EtherCAT decoder finds in our frames: from power-on to OP, with segmented
// SDOs, SDO information and cycles, not one malformed packet.

#include "ecat/recording/frame_capture.hpp"

#include <gmock/gmock.h>

#include <algorithm>
#include <cstdio>
#include <cstdlib>
#include <filesystem>
#include <sstream>

#include "ecat/coe/object_info.hpp"
#include "tests/ecat/diagnosis/probed_bus.hpp"
#include "tests/ecat/wire/captures.hpp"

namespace taktwerk::ecat {
namespace {

using namespace std::chrono_literals;
using testing::HasSubstr;

class FrameCaptureFile : public ::testing::Test {
protected:
    FrameCaptureFile() {
        auto pattern = (std::filesystem::temp_directory_path() / "taktwerk-test-XXXXXX").string();
        folder_ = ::mkdtemp(pattern.data());
    }
    ~FrameCaptureFile() override { std::filesystem::remove_all(folder_); }
    [[nodiscard]] std::string path() const { return folder_ + "/bus.pcapng"; }

    /// What tshark makes of the file: a line a packet, the fields with tabs between them. Empty where a packet has none.
    [[nodiscard]] std::vector<std::vector<std::string>> tshark(const std::vector<std::string>& fields) const {
        std::string command = "tshark -r '" + path() + "' -T fields -E occurrence=a";
        for (const auto& field : fields) command += " -e " + field;
        std::FILE* pipe = ::popen((command + " 2>/dev/null").c_str(), "r");
        std::string text;
        char part[4096];
        for (std::size_t got = 0; (got = std::fread(part, 1, sizeof part, pipe)) > 0;) text.append(part, got);
        ::pclose(pipe);
        std::vector<std::vector<std::string>> packets;
        std::istringstream lines{text};
        for (std::string line; std::getline(lines, line);) {
            std::vector<std::string> packet;
            std::istringstream cells{line};
            for (std::string cell; std::getline(cells, cell, '\t');) packet.push_back(cell);
            packet.resize(fields.size());
            packets.push_back(std::move(packet));
        }
        return packets;
    }

    std::string folder_;
};

// draft-ietf-opsawg-pcapng: section header, interface description, enhanced packet, each with its length at both ends.
TEST_F(FrameCaptureFile, HasTheHeadAndTheFramesAsTheyWere) {
    auto capture = FrameCapture::create(path(), {.interface = "eth1", .comment = {}, .epoch = 1000s});
    ASSERT_TRUE(capture) << capture.error().text();
    const std::vector<std::byte> frame(61, std::byte{0xA5});

    FrameCapture::tap(capture->get(), frame, Instant{1'500'000'001ns}, true);
    FrameCapture::tap(capture->get(), frame, Instant{1'500'000'301ns}, false);
    ASSERT_TRUE((*capture)->finish());

    const auto file = test::read_file(path());
    const auto u32 = [&](std::size_t at) { return load_le<std::uint32_t>(file, at); };
    const auto u16 = [&](std::size_t at) { return load_le<std::uint16_t>(file, at); };
    const auto next = [&](std::size_t at) {
        EXPECT_EQ(u32(at + 4) % 4, 0u);
        EXPECT_EQ(u32(at + u32(at + 4) - 4), u32(at + 4)) << "its length stands at its end, too";
        return at + u32(at + 4);
    };
    EXPECT_EQ(u32(0), 0x0A0D0D0Au);
    EXPECT_EQ(u32(8), 0x1A2B3C4Du) << "little endian";
    EXPECT_EQ(u16(12), 1) << "version 1.0";
    EXPECT_EQ(u16(14), 0);
    EXPECT_EQ(load_le<std::uint64_t>(file, 16), ~std::uint64_t{0}) << "as long as it is";

    const auto interface = next(0);
    EXPECT_EQ(u32(interface), 1u);
    EXPECT_EQ(u16(interface + 8), 1) << "Ethernet";
    EXPECT_EQ(u32(interface + 12), 0u) << "no frame is cut";
    EXPECT_EQ(u16(interface + 16), 2) << "if_name";
    EXPECT_EQ(u16(interface + 18), 4);
    EXPECT_EQ(static_cast<char>(file[interface + 20]), 'e');
    EXPECT_EQ(u16(interface + 24), 9) << "if_tsresol";
    EXPECT_EQ(u16(interface + 26), 1);
    EXPECT_EQ(file[interface + 28], std::byte{9}) << "10^-9 s";

    const auto sent = next(interface);
    EXPECT_EQ(u32(sent), 6u);
    EXPECT_EQ((std::uint64_t{u32(sent + 12)} << 32) | u32(sent + 16), 1'001'500'000'001u) << "1000 s + 1.5 s";
    EXPECT_EQ(u32(sent + 20), 61u);
    EXPECT_EQ(u32(sent + 24), 61u);
    EXPECT_EQ(file[sent + 28 + 60], std::byte{0xA5});
    EXPECT_EQ(file[sent + 28 + 61], std::byte{0}) << "filled up to 32 bits";
    EXPECT_EQ(u16(sent + 28 + 64), 2) << "epb_flags";
    EXPECT_EQ(u32(sent + 28 + 68), 2u) << "outbound";
    const auto received = next(sent);
    EXPECT_EQ(u32(received + 28 + 68), 1u) << "inbound";
    EXPECT_EQ(next(received), file.size());
    EXPECT_EQ((*capture)->frames(), 2u);
}

TEST_F(FrameCaptureFile, ADiskThatTakesNothingIsToldOnceAndAtTheEnd) {
    auto capture = FrameCapture::create("/dev/full");
    if (!capture) GTEST_SKIP() << "no /dev/full here";
    const std::vector<std::byte> frame(1500);
    int told = 0;
    for (int i = 0; i < 100; ++i) {
        FrameCapture::tap(capture->get(), frame, Instant{}, true);
        told += (*capture)->drain() ? 0 : 1;
    }
    EXPECT_EQ(told, 1);
    const auto end = (*capture)->finish();
    ASSERT_FALSE(end);
    EXPECT_EQ(end.error().code, "capture.write");
    EXPECT_THAT(end.error().text(), HasSubstr("/dev/full"));
}

TEST_F(FrameCaptureFile, APlaceThatCannotBeWrittenIsNamed) {
    const auto capture = FrameCapture::create("/nowhere/bus.pcap");
    ASSERT_FALSE(capture);
    EXPECT_EQ(capture.error().code, "capture.write");
    EXPECT_THAT(capture.error().text(), HasSubstr("/nowhere/bus.pcap"));
}

Script<Result<void>> talk(Bus& bus, BusSlave& slave) {
    // 300 bytes through a mailbox of 128: an upload in segments (the dictionary of probed_bus.hpp).
    const Result<std::vector<std::byte>> text = co_await sdo_upload(bus.port, slave.mailbox, 0x2000, 1);
    if (!text) co_return text.error();
    if (text->size() != 300) co_return Error{"test", "", "not the whole string", ""};
    const Result<std::vector<std::uint16_t>> list = co_await list_objects(bus.port, slave.mailbox, ObjectList::all);
    if (!list) co_return list.error();
    const Result<ObjectInfo> object = co_await describe_object(bus.port, slave.mailbox, 0x607A);
    if (!object) co_return object.error();
    const Result<EntryInfo> entry = co_await describe_entry(bus.port, slave.mailbox, 0x607A, 0);
    if (!entry) co_return entry.error();
    const Result<std::vector<std::byte>> nothing = co_await sdo_upload(bus.port, slave.mailbox, 0x2FFF, 0);  // aborted
    if (nothing) co_return Error{"test", "", "2FFFh is not there", ""};
    co_return Result<void>{};
}

TEST_F(FrameCaptureFile, TsharkDecodesBringUpSegmentedSdoInformationAndCycles) {
    if (std::system("tshark --version >/dev/null 2>&1") != 0) GTEST_SKIP() << "tshark is not installed";
    auto device = test::servo_description();
    device->mailbox->sdo_info = true;
    sim::SimNetwork network;
    network.add(device, std::make_unique<test::EchoServo>());
    network.add(test::terminal_description(), std::make_unique<test::InvertingTerminal>());
    LoopbackTransport transport{network};
    BusConfig config;
    SlaveConfig servo, terminal;
    servo.name = "servo";
    servo.device = device;
    servo.position = 0;
    servo.dc = true;
    terminal.name = "terminal";
    terminal.device = test::terminal_description();
    terminal.position = 1;
    config.slaves = {servo, terminal};
    auto capture = FrameCapture::create(path());
    ASSERT_TRUE(capture);
    Instant now{};
    BusProbe probe{transport, config, [&](Duration period) {
                       now += period;
                       (void)(*capture)->drain().ok();
                       return std::optional{now};
                   }};
    probe.master().set_tap(&FrameCapture::tap, capture->get());

    const auto up = probe.bring_up();
    ASSERT_TRUE(up) << up.error().text();
    const auto talked = probe.run(talk(probe.bus(), *probe.bus().slaves[0]));
    ASSERT_TRUE(talked) << talked.error().text();
    ASSERT_TRUE(probe.run_for(200ms));
    ASSERT_TRUE(probe.take_down());
    ASSERT_TRUE((*capture)->finish());
    ASSERT_EQ((*capture)->dropped(), 0u);

    enum Field { protocols, malformed, invalid, command, service, segment_request, segment, name, abort };
    const auto packets =
        tshark({"frame.protocols", "_ws.malformed", "ecat_mailbox.coe.invalid", "ecat.cmd", "ecat_mailbox.coe.type",
                "ecat_mailbox.coe.sdoccsus", "ecat_mailbox.coe.sdoscsus", "ecat_mailbox.coe.sdoinfoname", "ecat_mailbox.coe.abortcode"});
    const auto count = [&](Field field, const std::string& part) {
        return std::count_if(packets.begin(), packets.end(),
                             [&](const auto& packet) { return !packet[field].empty() && packet[field].find(part) != std::string::npos; });
    };
    ASSERT_EQ(packets.size(), (*capture)->frames());
    EXPECT_EQ(count(protocols, "ecat"), static_cast<std::ptrdiff_t>(packets.size()));
    EXPECT_EQ(count(malformed, ""), 0);
    EXPECT_EQ(count(invalid, ""), 0);
    EXPECT_GT(count(command, "0x0c"), 200) << "LRW (ETG.1000.4): 200 cycles, out and back";
    EXPECT_GT(count(command, "0x0e"), 200) << "FRMW with the reference time";
    EXPECT_GE(count(segment_request, ""), 2);
    EXPECT_GE(count(segment, ""), 2);
    EXPECT_GE(count(service, "8"), 6) << "SDO information: three requests, three answers";
    EXPECT_GE(count(name, "Target position"), 1);
    EXPECT_GE(count(abort, "0x06020000"), 1);
}

}  // namespace
}  // namespace taktwerk::ecat
