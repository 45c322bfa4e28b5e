#include "modbus/server/listen_address.hpp"

#include <gtest/gtest.h>

namespace taktwerk::modbus::server {
namespace {

TEST(ListenAddress, IsANumericAddressAndAPort) {
    EXPECT_EQ(parse_listen_address("127.0.0.1:502"), (ListenAddress{"127.0.0.1", 502}));
    EXPECT_EQ(parse_listen_address("[::1]:1502"), (ListenAddress{"::1", 1502}));
    for (const char* text : {"224.0.0.1:502",
                             "255.255.255.255:502",
                             "[ff02::1]:502",
                             "0.1.2.3:502",
                             "[::ffff:127.0.0.1]:502",
                             "[::ffff:0.0.0.0]:502",
                             "",
                             "502",
                             ":502",
                             "localhost:502",
                             "127.0.0.1",
                             "127.0.0.1:",
                             "127.0.0.1:0",
                             "127.0.0.1:65536",
                             "127.0.0.1:5o2",
                             "::1:502",
                             "[127.0.0.1]:502",
                             "[]:502",
                             "127.1:502",
                             "127.0.0.1:+502",
                             "127.0.0.1: 502"})
        EXPECT_FALSE(parse_listen_address(text)) << text;
    for (const char* text : {"127.0.0.1:502", "[fe80::1]:7", "0.0.0.0:65535"}) EXPECT_EQ(text_of(*parse_listen_address(text)), text);
}

TEST(ListenAddress, SaysWhoReachesIt) {
    EXPECT_EQ(reach_of({"127.0.0.1", 1}), Reach::this_computer);
    EXPECT_EQ(reach_of({"127.4.5.6", 1}), Reach::this_computer);
    EXPECT_EQ(reach_of({"::1", 1}), Reach::this_computer);
    EXPECT_EQ(reach_of({"192.168.1.10", 1}), Reach::one_port);
    EXPECT_EQ(reach_of({"fe80::1", 1}), Reach::one_port);
    EXPECT_EQ(reach_of({"0.0.0.0", 1}), Reach::every_port);
    EXPECT_EQ(reach_of({"::", 1}), Reach::every_port);
}

}  // namespace
}  // namespace taktwerk::modbus::server
