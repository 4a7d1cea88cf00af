#include "io/utf8.hpp"
#include "validation/unit/catch.hpp"

using namespace selvage;

TEST_CASE("text for a terminal has no control characters")
{
    const std::string sign = "\xef\xbf\xbd";
    CHECK(printable("h\xc3\xa9md \xe2\x82\xac") == "h\xc3\xa9md \xe2\x82\xac");
    CHECK(printable("\x1b[2Ja\rb\n\x7f") == sign + "[2Ja" + sign + "b" + sign + sign);
    CHECK(printable("\xc2\x9b"
                    "31m\xc2\xa0") == sign + "31m\xc2\xa0");  // CSI as one character; a space
    CHECK(printable("\xff") == sign);
}

TEST_CASE("bytes that are no UTF-8 become U+FFFD one by one, and what is UTF-8 stays")
{
    const std::string sign = "\xef\xbf\xbd";
    for (const std::string text : {"", "plain", "h\xc3\xa9md", "\xe2\x82\xac", "\xf0\x9f\x91\x95", "\xef\xbf\xbd"})
        CHECK(valid_utf8(text) == text);
    CHECK(valid_utf8("h\xe9md") == "h" + sign + "md");
    CHECK(valid_utf8("\xe2\x82") == sign + sign);                                   // cut off
    CHECK(valid_utf8("\xc0\xaf\xe0\x80\xaf") == sign + sign + sign + sign + sign);  // overlong
    CHECK(valid_utf8("\xed\xa0\x80") == sign + sign + sign);                        // a surrogate
    CHECK(valid_utf8("\xf4\x90\x80\x80\xff") == sign + sign + sign + sign + sign);
}
