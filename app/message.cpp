// See message.h.
#include "app/message.h"

namespace tessera {

QString asSentence(const std::string& text) {
    QString sentence = QString::fromStdString(text).trimmed();
    if (sentence.isEmpty()) return sentence;
    sentence[0] = sentence[0].toUpper();
    return sentence.endsWith('.') ? sentence : sentence + '.';
}

}  // namespace tessera
