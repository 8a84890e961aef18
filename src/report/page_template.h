#pragma once
// The page's own text, made of page/ when the library is built. Private to the page.

#include <string_view>

namespace goniofit {

/// The page is head + title (escaped) + middle + data (JSON without '<') + tail.
struct PageTemplate {
  std::string_view head, middle, tail;
};
extern const PageTemplate page_template;

}  // namespace goniofit
