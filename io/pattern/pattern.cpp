#include "io/pattern/pattern.hpp"

#include "io/pattern/json_text.hpp"

namespace selvage {

InputPlace Pattern::place(const std::string& key) const
{
    return text.empty() ? InputPlace{file, 0, 0, key} : place_of_value(text, file, key);
}

}  // namespace selvage
