// The EEPROM of a simulated slave, as a master reads it: no further than the size that word 3Eh states (ETG.1000.6 table 17: kbit less 1).
#include "ecat/sim/sii_image.hpp"

#include <gtest/gtest.h>

#include "core/bytes.hpp"
#include "ecat/sim/digital_terminal.hpp"
#include "ecat/wire/sii.hpp"

namespace taktwerk::ecat::sim {
namespace {

class SiiImageOf : public ::testing::TestWithParam<int> {};

TEST_P(SiiImageOf, ALargeTerminalIsWholeWithinTheSizeItStates) {
    const auto bits = static_cast<std::uint8_t>(GetParam());
    const auto image = sii_image(digital_input_output_terminal(bits, bits), 0, 0);

    const std::size_t stated = (load_le<std::uint16_t>(image, 2 * sii_word::size) + std::size_t{1}) * 128;
    ASSERT_LE(stated, image.size());
    const Sii read = parse_sii(std::span{image}.first(stated));

    EXPECT_TRUE(read.defects.empty());
    ASSERT_EQ(read.rx_pdos.size(), 1u);
    ASSERT_EQ(read.tx_pdos.size(), 1u);
    EXPECT_EQ(read.rx_pdos[0].entries.size(), bits);
    EXPECT_EQ(read.tx_pdos[0].entries.size(), bits);
    EXPECT_EQ(stated, image.size()) << "nothing stands behind the memory";
}

INSTANTIATE_TEST_SUITE_P(Of, SiiImageOf, ::testing::Values(1, 8, 32, 64, 65, 128));

}  // namespace
}  // namespace taktwerk::ecat::sim
