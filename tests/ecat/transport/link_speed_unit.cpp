// The kernel's files of an interface, made by hand: what a slave's link looks like, and what others' do.
#include "ecat/transport/link_speed.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <unistd.h>

#include <filesystem>
#include <fstream>
#include <string>

namespace taktwerk::ecat {
namespace {

using ::testing::HasSubstr;
namespace fs = std::filesystem;

struct LinkSpeed : ::testing::Test {
    const fs::path sysfs = fs::temp_directory_path() / ("taktwerk-link-" + std::to_string(::getpid()));
    ~LinkSpeed() override { fs::remove_all(sysfs); }
    std::string told(const char* speed, const char* duplex, bool hardware = true) {
        fs::remove_all(sysfs);
        fs::create_directories(sysfs / "eth1" / (hardware ? "device" : "queues"));
        std::ofstream{sysfs / "eth1" / "speed"} << speed << "\n";
        std::ofstream{sysfs / "eth1" / "duplex"} << duplex << "\n";
        const auto trouble = link_speed_trouble("eth1", sysfs);
        return trouble ? trouble->text() : std::string{};
    }
};

TEST_F(LinkSpeed, ASlaveHasAHundredMegabitsFullDuplex) {
    EXPECT_EQ(told("100", "full"), "");
    EXPECT_EQ(told("-1", "unknown"), "") << "no link";
    EXPECT_EQ(told("10000", "full", false), "") << "a veth pair";
    EXPECT_FALSE(link_speed_trouble("eth7", sysfs)) << "no such interface: said elsewhere";
}

TEST_F(LinkSpeed, ASwitchIsKnownByItsGigabit) {
    EXPECT_THAT(told("1000", "full"), HasSubstr("network interface eth1: its link has 1000 Mbit, and an EtherCAT slave has 100"));
    EXPECT_THAT(told("10", "full"), HasSubstr("its link has 10 Mbit"));
}

TEST_F(LinkSpeed, HalfDuplexIsTold) { EXPECT_THAT(told("100", "half"), HasSubstr("its link is half duplex")); }

}  // namespace
}  // namespace taktwerk::ecat
