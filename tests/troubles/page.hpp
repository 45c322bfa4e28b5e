#pragma once
// docs/troubles.md: every trouble of the table with what was said when it was staged.

#include <functional>
#include <string>
#include <vector>

#include "tests/troubles/trouble.hpp"

namespace taktwerk::troubles {

[[nodiscard]] std::string troubles_page(const std::vector<Chapter>& chapters,
                                        const std::function<const std::vector<Said>&(const Trouble&)>& said_of);

}  // namespace taktwerk::troubles
