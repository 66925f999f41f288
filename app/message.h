// Something to tell the person in one sentence.
#pragma once

#include <QString>
#include <functional>
#include <string>

namespace tessera {

// With an action, the sentence asks whether to do it.
struct Message {
    enum class Kind { Info, Error };
    Kind kind = Kind::Info;
    QString text = {};
    QString actionText = {};
    std::function<void()> action = {};
};

// Core's messages are clauses that a command line puts after "error: "; a window shows them as sentences.
QString asSentence(const std::string& text);

}  // namespace tessera
