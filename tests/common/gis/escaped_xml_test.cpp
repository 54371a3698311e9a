// SPDX-FileCopyrightText: The Talus authors
// SPDX-License-Identifier: GPL-3.0-or-later
// Text inside XML and HTML. The pages and files that hold such text are tested with the programs that read them.
#include "common/gis/escaped_xml.hpp"

#include <gtest/gtest.h>

namespace talus {
namespace {

TEST(EscapedXml, marks_up_nothing) {
  EXPECT_EQ(escaped_xml("a <b> & \"c\""), "a &lt;b&gt; &amp; &quot;c&quot;");
  EXPECT_EQ(escaped_xml("</script><!--"), "&lt;/script&gt;&lt;!--");
}

TEST(EscapedXml, keeps_other_text_as_it_is) {
  EXPECT_EQ(escaped_xml(""), "");
  EXPECT_EQ(escaped_xml("Rüfe, 15° 'x'"), "Rüfe, 15° 'x'");
}

TEST(EscapedXml, leaves_control_characters_out) {
  EXPECT_EQ(escaped_xml("a\x01"
                        "b\tc"),
            "ab\tc");
}

}  // namespace
}  // namespace talus
