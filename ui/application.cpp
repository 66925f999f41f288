// See application.h.
#include "ui/application.h"

#include <QApplication>
#include <QIcon>
#include <QThreadPool>
#include <algorithm>

#include "app/settings.h"
#include "ui/theme.h"

// Outside of any namespace, as Qt asks.
static void initResources() {
    Q_INIT_RESOURCE(tessera);
}

namespace tessera {

namespace {

// A vectorization, a save, an export and the canvas at once: none waits for another to end.
constexpr int kMinWorkers = 5;

}  // namespace

void setUpApplication(QApplication& application) {
    initResources();
    QApplication::setApplicationName("Tessera");
    QApplication::setApplicationVersion(TESSERA_VERSION);
    QApplication::setDesktopFileName("tessera");
    QIcon icon;
    for (const int size : {16, 32, 64, 128, 256}) icon.addFile(QString(":/icons/tessera-%1.png").arg(size));
    QApplication::setWindowIcon(icon);
    QThreadPool* pool = QThreadPool::globalInstance();
    pool->setMaxThreadCount(std::max(kMinWorkers, pool->maxThreadCount()));
    applyTheme(application, Settings().theme());
}

}  // namespace tessera
