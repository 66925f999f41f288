// Something to tell the person in one sentence.
#pragma once

#include <QString>
#include <functional>
#include <string>

namespace tessera {

class DocumentSession;

// With an action, the sentence asks whether to do it.
struct Message {
    enum class Kind { Info, Error };
    Kind kind = Kind::Info;
    QString text = {};
    QString actionText = {};
    std::function<void()> action = {};
    // A question about something that would be lost: it is asked until it is answered, whatever else is said
    // meanwhile.
    bool keep = false;
    // The document that a kept question is about and ends with; null for none.
    const DocumentSession* about = nullptr;
};

// Core's messages are clauses that a command line puts after "error: "; a window shows them as sentences.
QString asSentence(const std::string& text);

}  // namespace tessera
