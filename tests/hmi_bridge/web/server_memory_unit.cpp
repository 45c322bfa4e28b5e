// What the page's server keeps of those who come and go: nothing. Run under the address sanitizer it also shows that nothing is left at its end.

#include <array>

#include "tests/hmi_bridge/web/served_site.hpp"

namespace taktwerk::hmi::web {
namespace {

using namespace std::chrono_literals;

class ServerMemory : public ServedSite {
protected:
    /// How many there are when all who went are forgotten, or after half a minute.
    std::size_t left() const {
        for (const auto until = PageClock::now() + 30s; alive() > 0 && PageClock::now() < until;) ::usleep(500);
        return alive();
    }
};

TEST_F(ServerMemory, AThousandPagesThatCameAndWentAreForgotten) {
    ServerOptions options;
    options.rate = 200;
    serve(std::move(options));
    constexpr std::size_t at_once = 10;
    for (int round = 0; round < 100; ++round) {
        std::array<PageClient, at_once> pages;
        for (std::size_t i = 0; i < at_once; ++i) {
            ASSERT_TRUE(pages[i].open(port)) << round;
            // Some look, some ask and wait for no answer, some command over a connection of their own, one says what nobody can read.
            if (i % 3 == 0) {
                EXPECT_FALSE(pages[i].next("hello").is_null());
            }
            if (i % 3 == 1) pages[i].command({{"cmd", "scope_read"}});
            if (i == 5) pages[i].command({{"cmd", "jog"}, {"axis", "x"}, {"velocity", 5}, {"press", true}});
            if (i == 8) pages[i].say_bytes("\x81\xfe");
        }
        EXPECT_GE(alive(), 5u) << "what is there is counted";
        for (auto& page : pages) page.close();
        ASSERT_EQ(left(), 0u) << round;
    }
    for (const auto until = PageClock::now() + 30s; machine.connections() > 2 && PageClock::now() < until;) ::usleep(500);
    EXPECT_LE(machine.connections(), 2u) << "the server's own, for values and for long answers";
}

// With pages that are open, answers that wait and a connection that has asked nothing yet.
TEST_F(ServerMemory, AServerThatEndsLetsGoOfWhoIsThere) {
    serve();
    std::array<PageClient, 4> pages;
    for (auto& page : pages) {
        ASSERT_TRUE(page.open(port));
        ASSERT_TRUE(shows_machine(page));
    }
    machine.long_answer = 1024 * 1024;
    pages[0].command({{"cmd", "scope_read"}});
    pages[1].command({{"cmd", "jog"}, {"axis", "x"}, {"velocity", 5}, {"press", true}});
    TcpEnd silent;
    ASSERT_TRUE(silent.open(port));
    const auto weak = memory();
    EXPECT_FALSE(weak.expired());
    end();
    EXPECT_TRUE(weak.expired()) << "pages and what they share hold each other";
    for (auto& page : pages) EXPECT_TRUE(page.is_closed(5s));
}

}  // namespace
}  // namespace taktwerk::hmi::web
