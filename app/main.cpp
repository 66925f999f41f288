// The program `tessera`: tessera [FILE] [--vectorize].
#include <QApplication>
#include <QCommandLineParser>

#include "ui/application.h"
#include "ui/main_window.h"

int main(int argc, char** argv) {
    QApplication application(argc, argv);
    tessera::setUpApplication(application);

    QCommandLineParser parser;
    parser.setApplicationDescription(
        "Turns photographs into vector images made of curved triangular patches.");
    parser.addHelpOption();
    parser.addVersionOption();
    parser.addPositionalArgument("FILE", "A photo or a .tessera document to open.", "[FILE]");
    const QCommandLineOption vectorize("vectorize", "Vectorize FILE as soon as it is open.");
    parser.addOption(vectorize);
    parser.process(application);

    tessera::MainWindow window;
    window.show();
    if (parser.positionalArguments().isEmpty()) {
        window.offerRecovery();
    } else {
        window.open(parser.positionalArguments().first());
        if (parser.isSet(vectorize)) window.vectorizeWhenOpen();
        window.mentionRecovery();
    }
    return QApplication::exec();
}
