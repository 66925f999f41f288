// What the window shows while no document is open: ways to begin, and the files of before.
#pragma once

#include <QHash>
#include <QImage>
#include <QStringList>
#include <QThreadPool>
#include <QWidget>

class QAbstractButton;
class QGridLayout;

namespace tessera {

class RecentCard;

// Accepts dropped files. Thumbnails are made on a worker of its own, which holds up no other work.
class StartPage : public QWidget {
    Q_OBJECT

  public:
    explicit StartPage(QWidget* parent = nullptr);
    ~StartPage() override;

    // Newest first.
    void setRecentFiles(const QStringList& paths);
    // Whether all thumbnails that there are, are shown.
    bool settled() const { return mLoading == 0; }

    // The sample picture as a file of the user's cache folder, put there where it is missing; empty where
    // that fails.
    static QString sampleFile();

  signals:
    void openRequested(const QString& path);
    void openDialogRequested();
    void sampleRequested();
    void pasteRequested();
    void clearRecentRequested();

  protected:
    void dragEnterEvent(QDragEnterEvent* event) override;
    void dragLeaveEvent(QDragLeaveEvent* event) override;
    void dropEvent(QDropEvent* event) override;
    void paintEvent(QPaintEvent* event) override;
    void resizeEvent(QResizeEvent* event) override;
    void changeEvent(QEvent* event) override;

  private:
    QWidget* makeDropArea();
    QWidget* makeRecentPart();
    void tintIcons();
    void loadThumbnail(RecentCard* card);
    void arrangeCards();
    void setDragging(bool dragging);

    QWidget* mDropArea;
    QWidget* mRecent;
    QGridLayout* mGrid;
    QList<RecentCard*> mCards;
    QHash<QString, QImage> mThumbnails;       // by path and time of change
    QHash<QAbstractButton*, QString> mIcons;  // their names
    int mColumns = 0;
    int mLoading = 0;
    bool mDragging = false;
    QThreadPool mPool;
};

}  // namespace tessera
