// Explicit device identification (ETG.1020): where a survey finds the id, and a bring-up by it.
#include <gmock/gmock.h>

#include "core/bytes.hpp"
#include "ecat/wire/sii.hpp"
#include "tests/ecat/diagnosis/probed_bus.hpp"

namespace taktwerk::ecat {
namespace {

using test::ProbedBus;
using ::testing::HasSubstr;

// ETG.2010, category General: byte 11 bit 4, the id stands at the address in bytes 18 and 19. Here: in the user RAM, where this test puts it.
TEST(DeviceId, IsReadWhereTheEepromSaysThatItStands) {
    ProbedBus bus{"ss"};
    auto& image = bus.network.slave(1).controller().eeprom().image();
    Sii sii = parse_sii(image);
    ASSERT_TRUE(sii.general);
    sii.general->flags |= sii_flag::id_in_memory;
    sii.general->id_address = reg::user_ram;
    image = build_sii(sii);
    EXPECT_FALSE(bus.look().slaves[1].found.device_id) << "0 is no id";
    std::array<std::byte, min_frame_size> buffer{};
    FrameBuilder builder{buffer, MacAddress{0x02, 0x11, 0x22, 0x33, 0x44, 0x55}};
    store_le(builder.add(Command::APWR, 1, Address::position(1, reg::user_ram), 2), 0, std::uint16_t{0x0042});
    (void)builder.finish();
    (void)bus.network.process(buffer, bus.now);
    const auto found = bus.look();
    EXPECT_EQ(found.slaves[1].found.device_id, 0x0042);
    EXPECT_FALSE(found.slaves[0].found.device_id);

    bus.config.slaves[1].position.reset();
    bus.config.slaves[1].device_id = 0x0042;
    ASSERT_TRUE(bus.bring_up()) << bus.why();
    ProbedBus other{"ss"};
    other.config.slaves[1].position.reset();
    other.config.slaves[1].device_id = 0x0043;
    EXPECT_FALSE(other.bring_up());
    EXPECT_THAT(other.why(), HasSubstr("there is no slave at device id 67"));
}

// AL control bit 5, the id in 0134h (ETG.1020), of slaves whose EEPROM says so: a survey shows it, and their state stays.
TEST(DeviceId, IsAskedThroughAlControlWhereTheEepromSaysSo) {
    ProbedBus bus{"s"};
    sim::SlaveOptions options;
    options.device_id = std::uint16_t{0x0117};
    bus.network.add(test::servo_description(), std::make_unique<test::EchoServo>(), options);
    const auto found = bus.look();
    EXPECT_EQ(found.slaves[1].found.device_id, 0x0117);
    EXPECT_FALSE(found.slaves[0].found.device_id);
    EXPECT_EQ(bus.state(1), sim::EsmState::init);
    EXPECT_EQ(found.slaves[1].state, AlState::init);
    EXPECT_FALSE(found.slaves[1].al_error);
}

}  // namespace
}  // namespace taktwerk::ecat
